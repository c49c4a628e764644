#!/usr/bin/env bash
# Runs every test. Installs software Vulkan (Mesa's lavapipe) first where no GPU adapter is found, and an X server without a
# screen with the libraries of windows where there is none. Sets Monado up for the tests of the headset.
set -euo pipefail
cd "$(dirname "$0")/.."

has_adapter() {
    cargo run --quiet -- doctor --json 2>/dev/null | grep '"is_software"' >/dev/null
}

# install "APT PACKAGES" "DNF PACKAGES" "PACMAN PACKAGES" "WHAT TO DO WITHOUT THEM"
install() {
    local as_root=() apt dnf pacman
    [ "$(id -u)" -eq 0 ] || as_root=(sudo)
    read -ra apt <<<"$1"
    read -ra dnf <<<"$2"
    read -ra pacman <<<"$3"
    if command -v apt-get >/dev/null; then
        "${as_root[@]}" apt-get update -qq
        "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${apt[@]}"
    elif command -v dnf >/dev/null; then
        "${as_root[@]}" dnf install -y "${dnf[@]}"
    elif command -v pacman >/dev/null; then
        "${as_root[@]}" pacman -S --noconfirm --needed "${pacman[@]}"
    else
        echo "$4, or set WHEATSTONE_SKIP_GPU_TESTS=1" >&2
        return 1
    fi
}

install_software_vulkan() {
    install "libvulkan1 mesa-vulkan-drivers" "vulkan-loader mesa-vulkan-drivers" "vulkan-icd-loader vulkan-swrast" \
        "no GPU adapter found: install a Vulkan loader and Mesa's lavapipe"
}

install_display() {
    install "xvfb libx11-6 libx11-xcb1 libxcursor1 libxi6 libxkbcommon-x11-0" \
        "xorg-x11-server-Xvfb libX11-xcb libXcursor libXi libxkbcommon-x11" \
        "xorg-server-xvfb libx11 libxcursor libxi libxkbcommon-x11" \
        "no display for the viewer: install Xvfb, libXcursor, libXi and libxkbcommon-x11"
}

has_display() {
    command -v Xvfb >/dev/null && ldconfig -p | grep libxkbcommon-x11.so.0 >/dev/null &&
        ldconfig -p | grep libXcursor.so.1 >/dev/null && ldconfig -p | grep libXi.so.6 >/dev/null
}

cargo build
if [ -z "${WHEATSTONE_SKIP_GPU_TESTS:-}" ] && ! has_adapter; then
    echo "no GPU adapter found: installing software Vulkan" >&2
    install_software_vulkan
fi
if [ -z "${WHEATSTONE_SKIP_GPU_TESTS:-}" ] && [ "$(uname)" = Linux ] && ! has_display; then
    echo "no Xvfb found: installing it" >&2
    install_display
fi
if [ -z "${WHEATSTONE_MONADO:-}${WHEATSTONE_SKIP_XR_TESTS:-}" ] && [ "$(uname)" = Linux ]; then
    status=0
    WHEATSTONE_MONADO=$(bash scripts/monado.sh) || status=$?
    case $status in
    0) export WHEATSTONE_MONADO ;;
    3)
        unset WHEATSTONE_MONADO
        export WHEATSTONE_SKIP_XR_TESTS="no packages of Monado"
        echo "THE TESTS OF THE HEADSET ARE SKIPPED: $WHEATSTONE_SKIP_XR_TESTS" >&2
        ;;
    *) exit "$status" ;;
    esac
fi
cargo test --workspace "$@"
