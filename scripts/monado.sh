#!/usr/bin/env bash
# Unpacks what the tests of the headset need into a folder: Monado (an OpenXR runtime with simulated headsets), the OpenXR loader,
# software Vulkan and Vulkan's validation layer. Nothing is installed and no root is needed; packages come from the machine's own
# sources of packages, are resolved as for an empty system, and checked by apt.
#
#   scripts/monado.sh [FOLDER]      FOLDER: ${XDG_CACHE_HOME:-$HOME/.cache}/wheatstone/monado by default
#
# A folder that is complete is left as it is. The last line of the output is the folder. Exit status 3: packages cannot be had here.
set -euo pipefail

# Raised when what is in the folder changes.
layout=1
oldest_monado=25
packages=(monado-service libopenxr1-monado libopenxr-loader1 mesa-vulkan-drivers vulkan-validationlayers)

folder=${1:-${XDG_CACHE_HOME:-$HOME/.cache}/wheatstone/monado}
mkdir -p "$(dirname "$folder")"
folder=$(cd "$(dirname "$folder")" && pwd)/$(basename "$folder")
if [ "$(cat "$folder/layout" 2>/dev/null)" = "$layout" ]; then
    echo "$folder"
    exit 0
fi

cannot() {
    echo "no Monado to test with: $1" >&2
    exit 3
}

command -v apt-get >/dev/null && command -v dpkg >/dev/null || cannot "it is unpacked from Debian's packages, and there is no apt here"

# Everything is put together aside, so that what is half done is never taken for whole.
aside=$(mktemp -d "$folder.XXXXXX")
trap 'rm -rf "$aside"' EXIT
mkdir -p "$aside"/apt/{state/lists/partial,cache/archives/partial} "$aside/root"
: >"$aside/apt/status"

private=(
    -o "Dir::State=$aside/apt/state" -o "Dir::State::status=$aside/apt/status" -o "Dir::Cache=$aside/apt/cache"
    -o "APT::Sandbox::User=$(id -un)" -o Acquire::Languages=none
)
candidate() {
    apt-cache "${private[@]}" policy libopenxr1-monado 2>/dev/null | awk '/Candidate:/ { print $2 }'
}

fetch_lists() {
    # apt only warns of what it cannot fetch.
    apt-get "${private[@]}" -qq update >&2 && [ -n "$(find "$aside/apt/state/lists" -name '*Packages*' -print -quit)" ]
}

echo "setting Monado up in $folder" >&2
fetch_lists || cannot "the lists of packages cannot be fetched"
if ! dpkg --compare-versions "$(candidate)" ge "$oldest_monado" 2>/dev/null; then
    # The release is too old. Debian's releases are on the same mirror.
    mirror=$(apt-get "${private[@]}" indextargets --format '$(ORIGIN) $(LABEL) $(REPO_URI)' 'Created-By: Packages' |
        awk '$1 == "Debian" && $2 == "Debian" { print $3; exit }')
    [ -n "$mirror" ] || cannot "this release has no Monado $oldest_monado, and its mirror has no newer release of Debian"
    keys=/usr/share/keyrings/debian-archive-keyring.gpg
    echo "deb [signed-by=$keys] $mirror trixie main" >"$aside/apt/sources.list"
    private+=(-o "Dir::Etc::sourcelist=$aside/apt/sources.list" -o Dir::Etc::sourceparts=-)
    fetch_lists || cannot "the lists of packages of Debian 13 cannot be fetched"
    dpkg --compare-versions "$(candidate)" ge "$oldest_monado" 2>/dev/null || cannot "no Monado $oldest_monado in Debian 13's packages"
fi
apt-get "${private[@]}" -qq -y --no-install-recommends --download-only install "${packages[@]}" >&2 ||
    cannot "the packages cannot be fetched"
for package in "$aside"/apt/cache/archives/*.deb; do
    dpkg -x "$package" "$aside/root"
done
rm -rf "$aside/apt" "$aside/root/usr/share"/{doc,icons,info,lintian,locale,man}

# What runs with these libraries is started by their own dynamic loader.
libraries=$(dirname "$(find "$aside/root/usr/lib" -name libopenxr_monado.so)")
libraries=${libraries#"$aside/"}
loader=$(find "$aside/root/usr/lib"* -maxdepth 2 -name 'ld-linux*.so.*' | head -n 1)
ln -s "${loader#"$aside/"}" "$aside/loader"
for part in "$libraries" root/usr/lib "$libraries"/{blas,lapack,pulseaudio}; do
    [ ! -d "$aside/$part" ] || echo "$folder/$part"
done | paste -sd : >"$aside/library-path"

# with_path MANIFEST: names the library in a manifest by its path.
with_path() {
    sed -E "s#(\"library_path\": *\")[^\"]*/?(lib[^/\"]+\")#\1$folder/$libraries/\2#" "$1"
}
with_path "$aside/root/usr/share/openxr/1/openxr_monado.json" >"$aside/runtime.json"
with_path "$(find "$aside/root/usr/share/vulkan/icd.d" -name 'lvp_icd*.json')" >"$aside/vulkan.json"
mkdir "$aside/layers"
with_path "$aside/root/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json" >"$aside/layers/validation.json"

echo "$layout" >"$aside/layout"
if [ -e "$folder" ]; then
    mv -T "$folder" "$aside.old"
    rm -rf "$aside.old"
fi
mv -T "$aside" "$folder" || [ "$(cat "$folder/layout")" = "$layout" ]
echo "$folder"
