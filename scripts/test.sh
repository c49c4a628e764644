#!/usr/bin/env bash
# Runs every test. Installs software Vulkan (Mesa's lavapipe) first where no GPU adapter is found.
set -euo pipefail
cd "$(dirname "$0")/.."

has_adapter() {
    cargo run --quiet -- doctor --json 2>/dev/null | grep '"is_software"' >/dev/null
}

install_software_vulkan() {
    local as_root=()
    [ "$(id -u)" -eq 0 ] || as_root=(sudo)
    if command -v apt-get >/dev/null; then
        "${as_root[@]}" apt-get update -qq
        "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
            libvulkan1 mesa-vulkan-drivers
    elif command -v dnf >/dev/null; then
        "${as_root[@]}" dnf install -y vulkan-loader mesa-vulkan-drivers
    elif command -v pacman >/dev/null; then
        "${as_root[@]}" pacman -S --noconfirm --needed vulkan-icd-loader vulkan-swrast
    else
        echo "no GPU adapter found: install a Vulkan loader and Mesa's lavapipe, or set WHEATSTONE_SKIP_GPU_TESTS=1" >&2
        return 1
    fi
}

cargo build
if [ -z "${WHEATSTONE_SKIP_GPU_TESTS:-}" ] && ! has_adapter; then
    echo "no GPU adapter found: installing software Vulkan" >&2
    install_software_vulkan
fi
cargo test --workspace "$@"
