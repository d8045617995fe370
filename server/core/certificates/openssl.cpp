// SPDX-License-Identifier: Apache-2.0
#include "certificates/openssl.h"

#include <new>

#include <openssl/err.h>

namespace viewloom {

OpensslPtr<BIO> readingBio(std::string_view bytes) {
  OpensslPtr<BIO> bio(BIO_new_mem_buf(bytes.data(), static_cast<int>(bytes.size())));
  if (bio == nullptr) throw std::bad_alloc();
  return bio;
}

OpensslPtr<BIO> writingBio() {
  OpensslPtr<BIO> bio(BIO_new(BIO_s_mem()));
  if (bio == nullptr) throw std::bad_alloc();
  return bio;
}

std::string bytesOf(BIO& bio) {
  char* bytes = nullptr;
  const long count = BIO_get_mem_data(&bio, &bytes);
  return count > 0 ? std::string(bytes, static_cast<size_t>(count)) : std::string();
}

std::string opensslReason() {
  const unsigned long code = ERR_peek_last_error();
  const char* const reason = code == 0 ? nullptr : ERR_reason_error_string(code);
  ERR_clear_error();
  return reason == nullptr ? "unknown reason" : reason;
}

}  // namespace viewloom
