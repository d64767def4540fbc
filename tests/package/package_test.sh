#!/usr/bin/env bash
# The library as other projects get it: package_test.sh install|find_package|pkg_config|subproject|symbols|desktop|notice SOURCE BUILD FOLDER
# FOLDER keeps the installation between the calls; `install` begins.
set -euo pipefail
what=$1 source=$2 build=$3 folder=$4
prefix=$folder/moved
consumer=$source/tests/package/consumer

# runs PROGRAM: the consumer prints its version, a distance and the folder of the networks.
runs() {
  local said
  said=$("$1")
  echo "$said"
  [[ $said =~ ^[0-9]+\.[0-9]+\.[0-9]+\ [1-9][0-9]*\.[0-9]\ m,\ networks\ in\ (/.*)$ && ${BASH_REMATCH[1]} == "$2"* ]]
}
configure() {
  rm -rf "$folder/$1"
  cmake -S "$consumer" -B "$folder/$1" -G Ninja "${@:2}" >"$folder/$1.log" 2>&1 || { cat "$folder/$1.log"; exit 1; }
}

case $what in
  install)
    rm -rf "$folder"
    mkdir -p "$folder"
    cmake --install "$build" --prefix "$folder/prefix" >/dev/null
    mv "$folder/prefix" "$prefix"  # nothing in it may know where it was
    if grep -rIl -e "$folder/prefix" -e "$source" "$prefix"; then echo "files name a folder of the build"; exit 1; fi
    "$prefix/bin/duoptic" version
    ;;
  find_package)
    configure found -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Debug
    cmake --build "$folder/found"
    runs "$folder/found/consumer" "$prefix"
    ;;
  pkg_config)
    export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
    libraries=$(pkg-config --libs duoptic)
    [[ $(pkg-config --libs-only-l duoptic | xargs) == -lduoptic ]] || { echo "more than the library: $libraries"; exit 1; }
    c++ -std=c++20 $(pkg-config --cflags duoptic) "$consumer/consumer.cpp" -o "$folder/by_pkg_config" $libraries
    LD_LIBRARY_PATH=$prefix/lib runs "$folder/by_pkg_config" "$prefix"
    # Found by a link to its folder, as by Debian's /lib, it still knows where it is.
    mkdir -p "$folder/linked"
    ln -sfn "$prefix/lib" "$folder/linked/lib"
    LD_LIBRARY_PATH=$folder/linked/lib runs "$folder/by_pkg_config" "$prefix"
    ;;
  subproject)
    # Its objects are those of this build, if its commands are the same; if they are not, the launcher says so.
    configure part -DDUOPTIC_SOURCE="$source" -DCMAKE_BUILD_TYPE=Release -DDUO_SPIRV="$build/spirv" \
      -DCMAKE_UNITY_BUILD="$(sed -n 's/^CMAKE_UNITY_BUILD:.*=//p' "$build/CMakeCache.txt")" \
      -DCMAKE_CXX_COMPILER_LAUNCHER="$source/tests/package/reuse_object"
    ninja -C "$folder/part" -t commands all >"$folder/commands.txt"
    if grep -e -Werror "$folder/commands.txt"; then echo "another project's warnings are errors"; exit 1; fi
    own=$(grep -e '-o CMakeFiles/consumer.dir.* -c ' "$folder/commands.txt")
    if [[ $own == *-ffp-contract* || $own == *-Wall* || $own == *-fvisibility* ]]; then echo "the project gets flags of the library: $own"; exit 1; fi
    if grep -E -e '-o [^ ]*(duoptic_tool|_test|/bin/duoptic)' "$folder/commands.txt"; then echo "more than the library"; exit 1; fi
    DUOPTIC_BUILT=$build cmake --build "$folder/part" --target consumer
    runs "$folder/part/consumer" "$source/models"
    ;;
  symbols)
    library=$(readlink -f "$prefix"/lib/libduoptic.so)
    nm -D --defined-only --demangle "$library" | cut -d' ' -f3- | sed -E 's/^(typeinfo( name)?|vtable|VTT|guard variable|non-virtual thunk|virtual thunk) (for|to) //' >"$folder/symbols.txt"
    [[ $(wc -l <"$folder/symbols.txt") -gt 100 ]] || { echo "hardly a symbol"; exit 1; }
    if grep -v '^duo::' "$folder/symbols.txt" | grep -vE '^[^(]* duo::[^(]*[<(]'; then echo "not of duo"; exit 1; fi
    # What is exported is named in a public header.
    sed -E 's/^[^(]* duo::/duo::/; s/^duo::(\(anonymous[^)]*\)::)?//; s/[^A-Za-z0-9_].*//' "$folder/symbols.txt" | sort -u | while read -r name; do
      grep -qrwF -- "$name" "$source/include/duoptic" || { echo "in no public header: $name"; exit 1; }
    done
    readelf -d "$library" | grep -q "SONAME.*libduoptic.so.${5%.*}\]"
    ;;
  desktop)
    # What menus and software centres show.
    command -v desktop-file-validate appstreamcli >/dev/null || { echo "skipped: no desktop-file-validate, or no appstreamcli"; exit 77; }
    share=$prefix/share
    desktop-file-validate "$share/applications/duoptic.desktop"
    appstreamcli validate --no-net "$share/metainfo/invalid.duoptic.Duoptic.metainfo.xml"
    [[ -s $share/icons/hicolor/scalable/apps/duoptic.svg ]]
    ;;
  notice)
    # Every library that the tool, the shared library and the Python module ask for is in NOTICE, and nothing else is.
    named() { sed -n "/^Loaded $1/,/^\$/p" "$source/NOTICE" | grep '^  lib' | cut -c1-52 | grep -oE '\blib[A-Za-z0-9_-]+' | sort -u; }
    for file in "$prefix/bin/duoptic" "$(readlink -f "$prefix"/lib/libduoptic.so)" "$prefix"/lib/python3*/*-packages/duoptic/*.so; do
      [[ ! -e $file ]] || objdump -p "$file" | sed -nE 's/^ *NEEDED +(lib[^.]+)\.so.*/\1/p'
    done | sort -u | grep -vxE 'libduoptic|libstdc\+\+|libm|libgcc_s|libc' | grep -vxF "$(named where)" >"$folder/needed.txt"
    named by >"$folder/named.txt"
    [[ -s $folder/named.txt ]]
    diff "$folder/named.txt" "$folder/needed.txt" || { echo "< only in NOTICE, > only in the programs"; exit 1; }
    ;;
esac
