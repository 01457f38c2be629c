# SPDX-License-Identifier: MIT
# shellcheck shell=bash
#
# Brings a Debian machine to what a script needs, and takes nothing away from it. Sourced, never run; needs stage.sh.

# program_of <package>: the program that a package is wanted for, nothing for a library. In PATH it counts as installed,
# wherever it comes from: Debian's own may not fit beside it (npm drives out another Node.js).
program_of() {
  case $1 in
    g++ | cmake | chromium | npm) echo "$1" ;;
    ninja-build) echo ninja ;;
    nodejs) echo node ;;
    clang) echo clang++ ;;
    gcc-arm-none-eabi) echo arm-none-eabi-g++ ;;
    g++-aarch64-linux-gnu) echo aarch64-linux-gnu-g++ ;;
    g++-arm-linux-gnueabihf) echo arm-linux-gnueabihf-g++ ;;
    qemu-system-arm) echo qemu-system-arm ;;
    qemu-user) echo qemu-aarch64 ;;
  esac
}

# package_present <package>
package_present() {
  local program
  if [[ $1 = *'|'* ]]; then
    package_present "${1%%|*}" || package_present "${1#*|}"
    return
  fi
  program=$(program_of "$1")
  if [ -n "$program" ] && command -v "$program" >/dev/null; then return 0; fi
  [ "$(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# one_of <name>[|<name>...]: names that a package has, or had, in different Debians. The first that apt can install; where
# it knows none, the first.
one_of() {
  local names name
  IFS='|' read -ra names <<<"$1"
  for name in "${names[@]}"; do
    if [[ $(LC_ALL=C apt-cache policy "$name" 2>/dev/null) =~ Candidate:\ [0-9] ]]; then
      echo "$name"
      return
    fi
  done
  echo "${names[0]}"
}

# require_packages <package>...: installs those that are missing, as root or through sudo where it asks for no
# password; otherwise prints the command to run and exits 1. `a|b`: one of them (one_of). Never removes a
# package. What apt-get says is in build/packages.log.
require_packages() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "This is not a Debian machine: assuming that what these packages hold is present: $*"
    return
  fi

  local missing=() chosen=() package
  for package in "$@"; do
    package_present "$package" || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0

  local as_root=() install=(apt-get install --yes --no-install-recommends --no-remove)
  if [ "$(id -u)" -ne 0 ]; then
    if command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
      as_root=(sudo -n)
    else
      for package in "${missing[@]}"; do chosen+=("$(one_of "$package")"); done
      die 1 "packages are missing; as root, run: apt-get update && ${install[*]} ${chosen[*]}"
    fi
  fi

  local log
  log=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)/build/packages.log
  if ! mkdir -p -- "${log%/*}" || ! : >"$log"; then die 1 "cannot write $log"; fi
  # env: sudo drops the variables of its caller
  as_root+=(env DEBIAN_FRONTEND=noninteractive)
  "${as_root[@]}" apt-get update >>"$log" 2>&1 </dev/null ||
    echo "apt-get update failed (see $log); trying with the lists that are here"
  for package in "${missing[@]}"; do chosen+=("$(one_of "$package")"); done
  echo "Installing ${chosen[*]}"
  "${as_root[@]}" "${install[@]}" -o DPkg::Lock::Timeout=120 "${chosen[@]}" >>"$log" 2>&1 </dev/null ||
    die 1 "could not install ${chosen[*]}: $(grep '^E:' "$log" | tail -n 1); all of it in $log"
}
