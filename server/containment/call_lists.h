// SPDX-License-Identifier: Apache-2.0
// System calls of a server, by name: those that it makes, and those that only an intruder makes.
// All others are refused. A name that a processor does not have is left out.
#pragma once

namespace viewloom {

// With any arguments.
inline constexpr const char* kAllowedCalls[] = {
    // Memory. mmap and mprotect also make code: lavapipe compiles kernels within the process.
    "brk", "get_mempolicy", "madvise", "membarrier", "memfd_create", "mincore", "mlock", "mlock2",
    "mmap", "mprotect", "mremap", "msync", "munlock", "munmap",
    // Threads.
    "exit", "exit_group", "futex", "futex_time64", "futex_waitv", "get_robust_list", "getcpu",
    "getpriority", "gettid", "rseq", "sched_get_priority_max", "sched_get_priority_min",
    "sched_getaffinity", "sched_getattr", "sched_getparam", "sched_getscheduler",
    "sched_setaffinity", "sched_setscheduler", "sched_yield", "set_robust_list", "set_tid_address",
    "setpriority",
    // Signals within the process.
    "restart_syscall", "rt_sigaction", "rt_sigpending", "rt_sigprocmask", "rt_sigreturn",
    "rt_sigsuspend", "rt_sigtimedwait", "rt_sigtimedwait_time64", "sigaltstack",
    // Time.
    "clock_getres", "clock_gettime", "clock_gettime64", "clock_nanosleep", "clock_nanosleep_time64",
    "gettimeofday", "nanosleep", "time", "timerfd_create", "timerfd_gettime", "timerfd_settime",
    "times",
    // Files, as far as landlock lets them be.
    "access", "close", "close_range", "copy_file_range", "dup", "dup2", "dup3", "faccessat",
    "faccessat2", "fadvise64", "fallocate", "fchmod", "fdatasync", "flock", "fstat", "fstatfs",
    "fsync", "ftruncate", "getcwd", "getdents", "getdents64", "lseek", "lstat", "mkdir", "mkdirat",
    "newfstatat", "open", "openat", "pread64", "preadv", "preadv2", "pwrite64", "pwritev",
    "pwritev2", "read", "readahead", "readlink", "readlinkat", "readv", "rename", "renameat",
    "renameat2", "rmdir", "sendfile", "stat", "statfs", "statx", "umask", "unlink", "unlinkat",
    "utimensat", "write", "writev",
    // Changes of files that are read anew.
    "inotify_add_watch", "inotify_init1", "inotify_rm_watch",
    // Waiting.
    "epoll_create", "epoll_create1", "epoll_ctl", "epoll_pwait", "epoll_pwait2", "epoll_wait",
    "eventfd2", "pipe", "pipe2", "poll", "ppoll", "ppoll_time64", "pselect6", "pselect6_time64",
    "select",
    // Connections that others open.
    "accept", "accept4", "bind", "getpeername", "getsockname", "getsockopt", "listen", "recvfrom",
    "recvmmsg", "recvmsg", "setsockopt", "shutdown",
    // The process and the machine.
    "arch_prctl", "getegid", "geteuid", "getgid", "getgroups", "getpgrp", "getpid", "getppid",
    "getrandom", "getresgid", "getresuid", "getrlimit", "getrusage", "getuid", "kcmp", "sysinfo",
    "uname"};

// Nothing in a server makes these calls, nor do libraries try them: the process ends.
inline constexpr const char* kDeadlyCalls[] = {"add_key",
                                               "bpf",
                                               "chroot",
                                               "delete_module",
                                               "execve",
                                               "execveat",
                                               "finit_module",
                                               "fsconfig",
                                               "fsmount",
                                               "fsopen",
                                               "init_module",
                                               "ioperm",
                                               "iopl",
                                               "kexec_file_load",
                                               "kexec_load",
                                               "keyctl",
                                               "mount",
                                               "mount_setattr",
                                               "move_mount",
                                               "open_by_handle_at",
                                               "open_tree",
                                               "perf_event_open",
                                               "pivot_root",
                                               "process_vm_readv",
                                               "process_vm_writev",
                                               "ptrace",
                                               "reboot",
                                               "request_key",
                                               "setns",
                                               "swapoff",
                                               "swapon",
                                               "umount2",
                                               "unshare",
                                               "userfaultfd"};

// Libraries try these and do without where a kernel does not have them (ENOSYS). The filter cannot
// read the arguments of clone3, which are in memory; glibc takes clone then.
inline constexpr const char* kMissingCalls[] = {"clone3", "io_uring_setup", "openat2"};

}  // namespace viewloom
