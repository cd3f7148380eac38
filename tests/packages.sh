#!/bin/sh
# The Debian packages on paper, before dpkg makes them: every installed file belongs to one package, manual pages, completion,
# pkg-config and CMake among them; the changelog has this version; who builds them can be their maintainer; what is built
# against a library depends on the versions that suit it; debian/copyright knows whose the recorded movements are.
. tests/begin.sh
debian=.packaging/debian version=$(sed -n 's/.*define ETHD_VERSION "\(.*\)".*/\1/p' include/ethd/ethd.h)
head -n 1 $debian/changelog | grep -qF "($version)" || fail "the changelog begins with $(head -n 1 $debian/changelog), not with $version"
grep -q '^### '"$version" include/README.md || fail "include/README.md has no changes of $version"
[ "$(sed -n 's/^Maintainer: //p' $debian/control)" = "$(sed -n 's/^ -- \(.*>\)  .*/\1/p' $debian/changelog | head -n 1)" ] ||
  fail "control and changelog name two maintainers"
$MAKE --no-print-directory -s B="$BUILD" DESTDIR="$folder/root" PREFIX=/usr LIBDIR=/usr/lib/machine install-files >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
rm -r "$folder/root/usr/share/ethd/installed" "$folder/root/usr/share/doc" # debian/copyright stands for the licence
(cd "$folder/root" && find . ! -type d | sed 's|^\./||' | sort) >"$folder/files"
for list in $debian/*.install; do
  package=${list##*/} package=${package%.install}
  grep -q "^Package: $package$" $debian/control || fail "$list is of no package"
  while read -r pattern; do
    # a folder stands for all that is in it
    while read -r file; do case $file in $pattern | $pattern/*) echo "$file $package" ;; esac; done <"$folder/files"
  done <"$list"
done | sort >"$folder/owned"
cut -d' ' -f1 "$folder/owned" | comm -23 "$folder/files" - >"$folder/lost"
[ ! -s "$folder/lost" ] || fail "in no package: $(cat "$folder/lost")"
cut -d' ' -f1 "$folder/owned" | uniq -d >"$folder/twice"
[ ! -s "$folder/twice" ] || fail "in two packages: $(cat "$folder/twice")"
has() { grep -qx "usr/$1 $2" "$folder/owned" || fail "$2 hasn't usr/$1"; }
has lib/machine/libethd.so.0 libethd0
has lib/machine/libethd-drivers.so.0 libethd0
has lib/machine/libethd.so libethd-dev
has lib/machine/libethd-drivers.a libethd-dev
has lib/machine/pkgconfig/ethd-drivers.pc libethd-dev
has lib/machine/cmake/ethd/ethdConfig.cmake libethd-dev
has include/ethd/ethd.h libethd-dev
[ -n "${SAN:-}" ] || has share/man/man3/libethd.3 libethd-dev
for program in "$BUILD"/bin/ethd-*; do
  has "bin/${program##*/}" ethd-tools
  [ -n "${SAN:-}" ] || has "share/man/man1/${program##*/}.1" ethd-tools
  has "share/bash-completion/completions/${program##*/}" ethd-tools
done
for pattern in $(cat $debian/libethd-dev.examples); do [ -e "$pattern" ] || fail "no example $pattern"; done

# Until 1.0 a minor version may change anything (include/README.md), although the SONAME stays.
major=${version%%.*} minor=${version#*.} minor=${minor%%.*}
suits="libethd0 (>= $major.$minor.0), libethd0 (<< $([ "$major" = 0 ] && echo "0.$((minor + 1))~" || echo "$((major + 1))~"))"
for library in "$BUILD"/lib*.so.?*; do
  name=${library##*/}
  grep -qxF "${name%.so.*} ${name##*.so.} $suits" $debian/libethd0.shlibs || fail "libethd0.shlibs doesn't say: ${name%.so.*} ${name##*.so.} $suits"
done
sed -n 's/^Files: //p' $debian/copyright | grep -v '^[*]$' >"$folder/foreign"
for movement in tests/motion/*/*; do
  case $movement in tests/motion/LICENSES/*) continue ;; esac
  while read -r pattern; do case $movement in $pattern) continue 2 ;; esac; done <"$folder/foreign"
  fail "debian/copyright doesn't say whose $movement is"
done
[ $failed = 0 ] && echo "$(wc -l <"$folder/files") files, each in one package"
exit $failed
