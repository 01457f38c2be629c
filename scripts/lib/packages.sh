# SPDX-License-Identifier: MIT
# shellcheck shell=bash
#
# Brings a Debian machine to what a script needs. Sourced, never run; needs stage.sh.

# package_installed <package>
package_installed() {
  [ "$(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# require_packages <package>...: installs those that are missing, as root or through sudo where it asks for no
# password; otherwise prints the command to run and exits 1.
require_packages() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "This is not a Debian machine: assuming that what these packages hold is present: $*"
    return
  fi

  local missing=() package
  for package in "$@"; do
    package_installed "$package" || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0

  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
      as_root=(sudo -n)
    else
      die 1 "packages are missing; run: sudo apt-get update && sudo apt-get install -y --no-install-recommends ${missing[*]}"
    fi
  fi

  echo "Installing ${missing[*]}"
  # env: sudo drops the variables of its caller
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -qq </dev/null ||
    echo "apt-get update failed; trying with the lists that are here"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" </dev/null ||
    die 1 "could not install: ${missing[*]}"
}
