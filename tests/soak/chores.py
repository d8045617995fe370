# SPDX-License-Identifier: Apache-2.0
"""Changes of certificates and tokens, good and bad, while clients come and go."""

from place import replace

DAMAGED = b"-----BEGIN CERTIFICATE-----\nnonsense\n"


class Chores:
    """One chore a round, each in its turn."""

    def __init__(self, protection):
        self.protection = protection
        self.round = 0

    def next(self):
        chores = (self.renew, self.damage_certificate, self.add_token, self.damage_tokens,
                  self.revoke_token)
        chores[self.round % len(chores)]()
        self.round += 1

    def renew(self):
        """The other certificate."""
        pairs = self.protection.pairs
        self.protection.use(pairs[self.round % len(pairs)])

    def damage_certificate(self):
        """The server keeps the one before."""
        replace(self.protection.files()[0], DAMAGED)

    def add_token(self):
        self.protection.use(self.protection.pairs[0])
        self.protection.add("passing", "watch")

    def damage_tokens(self):
        """The server keeps the tokens from before."""
        self.good = self.protection.tokens.read_bytes()
        replace(self.protection.tokens, b"nonsense\n")

    def revoke_token(self):
        replace(self.protection.tokens, self.good)
        self.protection.revoke("passing")
