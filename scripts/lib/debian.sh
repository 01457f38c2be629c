# SPDX-License-Identifier: MIT
# shellcheck shell=bash
#
# A Debian of its own in a folder, by debootstrap from this machine's mirror. Sourced, never run; needs stage.sh.

# debian_lacks: prints why none can be had here; nothing where it can
debian_lacks() {
  local program
  if [ "$(id -u)" -ne 0 ]; then echo "not root"; return; fi
  for program in debootstrap apt-get git unshare chroot; do
    if ! command -v "$program" >/dev/null; then echo "no $program"; return; fi
  done
  # mounts and processes of the chroot end with the command, however it ends
  if ! unshare --mount --pid --fork true 2>/dev/null; then echo "mounting is not allowed"; return; fi
  if [ -z "$(debian_mirror)" ]; then echo "apt has no list of a Debian mirror"; fi
}

# debian_mirror: site and suite of the first Debian among apt's sources; apt fills in what is in $( ).
debian_mirror() {
  # shellcheck disable=SC2016
  apt-get indextargets --format '$(ORIGIN) $(SITE) $(CODENAME)' 'Created-By: Packages' 2>/dev/null |
    awk '$1 == "Debian" && $3 !~ /-/ && !found { print $2, $3; found = 1 }' || true
}

# make_debian <folder> <suite> <package>... <log>: minbase with those packages and apt as it is here: the mirror, how it is
# reached, the names of hosts. The folder is there and empty.
make_debian() {
  local dir=$1 suite=$2 log=${!#} proxy site own
  local packages=("${@:3:$#-3}")
  read -r site own < <(debian_mirror)
  proxy=$(apt-config dump Acquire::http::Proxy | sed -n 's/^Acquire::http::Proxy "\(.*\)";$/\1/p')
  (
    if [ -n "$proxy" ]; then export http_proxy=$proxy; fi
    IFS=,
    debootstrap --variant=minbase ${packages[0]:+--include="${packages[*]}"} "$suite" "$dir" "$site"
  ) >"$log" 2>&1 || return
  rm -f -- "$dir/etc/apt/sources.list"
  if [ "$suite" = "$own" ]; then
    # with its updates
    # shellcheck disable=SC2016
    apt-get indextargets --format 'deb $(SITE) $(RELEASE) $(COMPONENT) # $(ORIGIN)' 'Created-By: Packages' |
      sed -n 's/ # Debian$//p' >"$dir/etc/apt/sources.list"
  else
    echo "deb $site $suite main" >"$dir/etc/apt/sources.list"
  fi
  apt-config dump | grep -E '^Acquire::(https?::|Check-|Retries)' >"$dir/etc/apt/apt.conf.d/90acquire" || true
  cp -L -- /etc/resolv.conf /etc/hosts "$dir/etc"
}

# in_debian <folder> <user> <command>...: with the environment of a fresh login
in_debian() {
  local dir=$1 user=$2 home=/root
  shift 2
  if [ "$user" != root ]; then home=/home/$user; fi
  unshare --mount --pid --fork --kill-child --mount-proc="$dir/proc" chroot "$dir" \
    runuser -u "$user" -- env -i HOME="$home" USER="$user" LANG=C.UTF-8 ${PINNQUAD_JOBS:+PINNQUAD_JOBS="$PINNQUAD_JOBS"} \
    PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin "$@" </dev/null
}
