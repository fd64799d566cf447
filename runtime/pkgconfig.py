# SPDX-License-Identifier: Apache-2.0
"""Fills perigee.pc in. usage: pkgconfig.py TEMPLATE FINGERPRINT-HEADER VERSION (the file goes to standard output)"""
import re
import sys


def main(template, header, version):
    with open(header, encoding="utf-8") as file:
        abi = re.search(r'"([0-9a-f]{64})"', file.read()).group(1)
    with open(template, encoding="utf-8") as file:
        sys.stdout.write(file.read().replace("@ABI@", abi).replace("@VERSION@", version))


if __name__ == "__main__":
    main(*sys.argv[1:])
