#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Hook of certbot: gives a new certificate to HAProxy, as one file in which the key follows the
# certificate. certbot names the certificate's folder in RENEWED_LINEAGE.
set -euo pipefail
umask 077
folder=/etc/viewloom
install -d -m 755 "$folder"
cat "$RENEWED_LINEAGE/fullchain.pem" "$RENEWED_LINEAGE/privkey.pem" > "$folder/front.pem.new"
mv "$folder/front.pem.new" "$folder/front.pem"
systemctl reload-or-restart haproxy
