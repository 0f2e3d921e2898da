#!/usr/bin/env bash
# nmap's s7-info, a common way to search for controls: list 0011 and list 001C.
set -euo pipefail
report=$(nmap -Pn -n -p "$S7_PORT" --script +s7-info 127.0.0.1)
failed=0 done=0
for line in 'Module: 6ES7 317-2EK14-0AB0' 'Basic Hardware: 6ES7 317-2EK14-0AB0' 'Version: 3.2.6' 'System Name: OpenNCK' \
    'Module Type: PLC 317-2 PN/DP' 'Serial Number: SIMULATED' 'Copyright: OpenNCK simulator'; do
    done=$((done + 1))
    if ! grep -qF "$line" <<<"$report"; then
        failed=$((failed + 1))
        printf 'FAILED %s:\n%s\n' "$line" "$report"
    fi
done
printf 'checks %s failed %s\n' "$done" "$failed"
[ "$failed" = 0 ]
