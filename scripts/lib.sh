# shellcheck shell=bash
# shellcheck disable=SC2034 # what is defined here is used by the scripts that source it
# Shared by play, test, setup and thesis-figures; sourced, never run. Expects `set -euo pipefail`.

ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
RUST_NEEDED=1.95
TARGET_DIR=${CARGO_TARGET_DIR:-target}
[[ $TARGET_DIR == /* ]] || TARGET_DIR=$ROOT/$TARGET_DIR
SPECULA=$TARGET_DIR/release/specula

# To build: the compilers and what shaderc's own build runs.
# To run: Vulkan with a software device, and the libraries that winit opens.
PACKAGES_PLAY=(
    ca-certificates curl cmake g++ git ninja-build pkg-config python3
    libvulkan1 mesa-vulkan-drivers
    libwayland-client0 libx11-6 libx11-xcb1 libxcb1 libxcursor1 libxi6 libxrandr2 libxkbcommon0 libxkbcommon-x11-0
)
# To test: validation layers, and a display for the window tests.
PACKAGES_TEST=(vulkan-validationlayers xauth xdotool xvfb)

say() { printf '%s\n' "specula: $*" >&2; }

die() {
    say "$@"
    exit 1
}

have() { command -v "$1" >/dev/null 2>&1; }

# is_at_least HAVE WANTED: compares versions of the form 1.2.3.
is_at_least() { [ "$(printf '%s\n%s\n' "$2" "$1" | sort -V | head -n 1)" = "$2" ]; }

# Prints those of the named packages that are not installed.
missing_packages() {
    local name state
    for name in "$@"; do
        # Newer releases renamed some libraries: libfoo1 became libfoo1t64.
        state=$(dpkg-query -W -f '${db:Status-Status}\n' "$name" "${name}t64" 2>/dev/null || true)
        case $'\n'$state in
        *$'\n'installed*) ;;
        *) printf '%s\n' "$name" ;;
        esac
    done
}

# install_packages NAME...: installs what is missing, or prints the line that does and ends.
install_packages() {
    local missing=() as_root=()
    if ! have dpkg-query || ! have apt-get; then
        say "this is not Debian or Ubuntu, so nothing is installed. Needed by these names there: $*"
        return 0
    fi
    mapfile -t missing < <(missing_packages "$@")
    [ "${#missing[@]}" -gt 0 ] || return 0
    local line="apt-get update && apt-get install -y --no-install-recommends ${missing[*]}"
    if [ "$(id -u)" -ne 0 ]; then
        if ! have sudo || ! sudo -n true 2>/dev/null; then
            say "system packages are missing. Run this, then run me again:"
            printf '\n    sudo sh -c "%s"\n\n' "$line" >&2
            exit 1
        fi
        as_root=(sudo -n env)
    else
        as_root=(env)
    fi
    say "installing ${missing[*]}"
    # A repository that is out of reach need not be the one that we want: let the installation decide.
    "${as_root[@]}" DEBIAN_FRONTEND=noninteractive apt-get update -qq >&2 || say "apt-get update failed; trying on"
    "${as_root[@]}" DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends --no-remove "${missing[@]}" </dev/null >&2 ||
        die "apt-get failed (its message is above). The line to run by hand:
    $line"
}

rust_version() { cargo --version 2>/dev/null | cut -d ' ' -f 2 | cut -d - -f 1; }

# Puts a cargo that is new enough on PATH, through the distribution's rustup where there is one.
ensure_rust() {
    local found
    if [ -d "$HOME/.cargo/bin" ]; then export PATH="$HOME/.cargo/bin:$PATH"; fi
    found=$(rust_version || true)
    if [ -n "$found" ] && is_at_least "$found" "$RUST_NEEDED"; then return 0; fi
    if ! have rustup && [[ $(apt-cache policy rustup 2>/dev/null) =~ Candidate:\ [0-9] ]]; then
        install_packages rustup
    fi
    if have rustup; then
        say "installing the stable Rust toolchain (found ${found:-none}, $RUST_NEEDED is needed)"
        rustup toolchain install stable --profile minimal --component clippy --component rustfmt >&2 ||
            die "rustup could not install Rust; its message is above"
        export RUSTUP_TOOLCHAIN=stable
        found=$(rust_version || true)
        if [ -n "$found" ] && is_at_least "$found" "$RUST_NEEDED"; then return 0; fi
    fi
    say "Rust $RUST_NEEDED or newer is needed, found ${found:-none}. Run this (see https://rustup.rs), then me again:"
    printf '\n    %s\n\n' "curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh" >&2
    exit 1
}

# Adds the parts of the toolchain that the checks need.
ensure_lints() {
    if cargo clippy --version >/dev/null 2>&1 && cargo fmt --version >/dev/null 2>&1; then return 0; fi
    have rustup || die "cargo clippy or cargo fmt is missing: install them from where $(command -v cargo) comes"
    rustup component add clippy rustfmt >&2 || die "rustup could not add clippy and rustfmt; its message is above"
}

# The newest shader compiler that cargo has built in this target folder.
built_shaderc() {
    local lib newest=
    for lib in "$TARGET_DIR"/release/build/shaderc-sys-*/out/lib/libshaderc_combined.a; do
        if [ -f "$lib" ] && [[ -z $newest || $lib -nt $newest ]]; then newest=$lib; fi
    done
    [ -n "$newest" ] && printf '%s\n' "$newest"
}

host_triple() { rustc -vV | sed -n 's/^host: //p'; }

# Where the shader compiler is kept between checkouts. A new version, target or compiler has another folder.
shaderc_cache() {
    local version gxx
    version=$(sed -n '/^name = "shaderc-sys"$/{n;s/^version = "\(.*\)"$/\1/p;}' "$ROOT/Cargo.lock")
    gxx=$(g++ -dumpversion 2>/dev/null | cut -d . -f 1)
    printf '%s\n' "${SPECULA_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/specula}/shaderc-$version-$(host_triple)-g++$gxx"
}

# Sets SHADERC_CONFIG: cargo options that link the kept shader compiler in place of ten minutes of C++.
#
# shaderc-sys with `build-from-source` ignores SHADERC_LIB_DIR, so its build script is overridden as cargo's `links` key
# allows. Cargo rebuilds whatever depends on it when the override comes or goes; hence one that built it here stays
# with that, as a plain `cargo build` does, and only a target folder without it uses the kept one.
use_kept_shaderc() {
    local cache triple
    SHADERC_CONFIG=()
    if built_shaderc >/dev/null; then return 0; fi
    cache=$(shaderc_cache)
    triple=$(host_triple)
    if [ -s "$cache/libshaderc_combined.a" ] && [[ $cache != *\'* ]]; then
        SHADERC_CONFIG=(
            --config "target.$triple.shaderc.rustc-link-search=['native=$cache']"
            --config "target.$triple.shaderc.rustc-link-lib=['static=shaderc_combined']"
        )
        say "using the shader compiler kept in $cache"
    else
        say "building the shader compiler (C++, about ten minutes on two cores; once)"
    fi
}

# Keeps the shader compiler that this target folder built. That it cannot be kept is no failure.
keep_shaderc() {
    local cache lib
    lib=$(built_shaderc) || return 0
    cache=$(shaderc_cache)
    [ ! -s "$cache/libshaderc_combined.a" ] || return 0
    # Renamed into place, so that nobody links half a file.
    if mkdir -p "$cache" && cp "$lib" "$cache/.$$.a" && mv "$cache/.$$.a" "$cache/libshaderc_combined.a"; then
        say "kept the shader compiler in $cache"
    else
        rm -f "$cache/.$$.a" || true
        say "could not keep the shader compiler in $cache (see above); the next fresh checkout builds it again"
    fi
}

# build_cargo COMMAND [ARGUMENTS]: cargo in the one profile that everything uses. The options stand after the command,
# because `cargo --config ... clippy` does not hand them on.
build_cargo() {
    local command=$1 status=0
    shift
    use_kept_shaderc
    (cd "$ROOT" && cargo "$command" "${SHADERC_CONFIG[@]}" --release --locked "$@") || status=$?
    if [ "$status" -eq 0 ]; then keep_shaderc; fi
    return "$status"
}
