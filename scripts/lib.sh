# shellcheck shell=bash
# shellcheck disable=SC2034 # the scripts that source this file use its variables
# Functions shared by the other scripts, which source this file. Expects `set -euo pipefail`.

ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
RUST_NEEDED=1.95
TARGET_DIR=${CARGO_TARGET_DIR:-target}
[[ $TARGET_DIR == /* ]] || TARGET_DIR=$ROOT/$TARGET_DIR
SPECULA=$TARGET_DIR/release/specula

# To build: compilers, and the tools that shaderc's build needs.
PACKAGES_BUILD=(ca-certificates curl cmake g++ git ninja-build pkg-config python3)
# To build and run: Vulkan with a software device, and the libraries that winit loads.
PACKAGES_PLAY=(
    "${PACKAGES_BUILD[@]}"
    libvulkan1 mesa-vulkan-drivers
    libwayland-client0 libx11-6 libx11-xcb1 libxcb1 libxcursor1 libxi6 libxrandr2 libxkbcommon0 libxkbcommon-x11-0
)
# To test: validation layers, an X server for the window tests, a browser for reports, an editor for the language server, and environments
# for Python.
PACKAGES_TEST=(chromium chromium-driver neovim python3-venv vulkan-validationlayers xauth xdotool xvfb)

say() { printf '%s\n' "specula: $*" >&2; }

die() {
    say "$@"
    exit 1
}

have() { command -v "$1" >/dev/null 2>&1; }

# is_at_least HAVE WANTED: compares versions of the form 1.2.3.
is_at_least() { [ "$(printf '%s\n%s\n' "$2" "$1" | sort -V | head -n 1)" = "$2" ]; }

# Prints the given packages that are not installed.
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

# install_packages NAME...: installs missing packages, or prints the command that does and exits.
install_packages() {
    local missing=() as_root=()
    if ! have dpkg-query || ! have apt-get; then
        say "this is not Debian or Ubuntu, so install these packages (Debian names) yourself: $*"
        return 0
    fi
    mapfile -t missing < <(missing_packages "$@")
    [ "${#missing[@]}" -gt 0 ] || return 0
    local line="apt-get update && apt-get install -y --no-install-recommends ${missing[*]}"
    if [ "$(id -u)" -ne 0 ]; then
        if ! have sudo || ! sudo -n true 2>/dev/null; then
            say "system packages are missing. Run this command, then this script again:"
            printf '\n    sudo sh -c "%s"\n\n' "$line" >&2
            exit 1
        fi
        as_root=(sudo -n env)
    else
        as_root=(env)
    fi
    say "installing ${missing[*]}"
    # An unreachable repository may not be needed, so only the installation may fail.
    "${as_root[@]}" DEBIAN_FRONTEND=noninteractive apt-get update -qq >&2 || say "apt-get update failed; trying to install anyway"
    "${as_root[@]}" DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends --no-remove "${missing[@]}" </dev/null >&2 ||
        die "apt-get failed (see its message above). To install by hand, run:
    $line"
}

rust_version() { cargo --version 2>/dev/null | cut -d ' ' -f 2 | cut -d - -f 1; }

# Ensures that a recent enough cargo is on PATH, by the distribution's rustup if there is one.
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
            die "rustup could not install Rust; see its message above"
        export RUSTUP_TOOLCHAIN=stable
        found=$(rust_version || true)
        if [ -n "$found" ] && is_at_least "$found" "$RUST_NEEDED"; then return 0; fi
    fi
    say "Rust $RUST_NEEDED or newer is needed, found ${found:-none}. Run this (see https://rustup.rs), then this script again:"
    printf '\n    %s\n\n' "curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh" >&2
    exit 1
}

# Adds clippy and rustfmt to the toolchain.
ensure_lints() {
    if cargo clippy --version >/dev/null 2>&1 && cargo fmt --version >/dev/null 2>&1; then return 0; fi
    have rustup || die "cargo clippy or cargo fmt is missing: install them from the same source as $(command -v cargo)"
    rustup component add clippy rustfmt >&2 || die "rustup could not add clippy and rustfmt; see its message above"
}

# Prints the folder that caches what is costly to make between checkouts.
cache_folder() { printf '%s\n' "${SPECULA_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/specula}"; }

# Prints the interpreter of the environment in which the tests of the Python package run, and makes the environment if it is not there: one for
# each list of packages and version of Python. pip and its registry are those of the system.
ensure_python() {
    local list=$ROOT/tests/python/requirements.txt folder
    folder=$(cache_folder)/python-$(python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')-$(sha256sum "$list" | cut -c 1-16)
    mkdir -p "$(dirname "$folder")"
    (
        flock 9
        [ ! -e "$folder/ready" ] || exit 0
        say "installing the Python packages of the tests in $folder"
        rm -rf "$folder"
        python3 -m venv "$folder" >&2 || die "python3 lacks its module venv; on Debian: apt-get install python3-venv"
        "$folder/bin/pip" install --quiet --disable-pip-version-check -r "$list" >&2 || die "pip could not install tests/python/requirements.txt"
        touch "$folder/ready"
    ) 9>"$folder.lock" || exit 1
    printf '%s\n' "$folder/bin/python"
}

# Prints the newest shaderc library that cargo has built in this target folder.
built_shaderc() {
    local lib newest=
    for lib in "$TARGET_DIR"/release/build/shaderc-sys-*/out/lib/libshaderc_combined.a; do
        if [ -f "$lib" ] && [[ -z $newest || $lib -nt $newest ]]; then newest=$lib; fi
    done
    [ -n "$newest" ] && printf '%s\n' "$newest"
}

host_triple() { rustc -vV | sed -n 's/^host: //p'; }

# Prints the folder that caches the shaderc library between checkouts: one per version, files of scripts/shaderc, target and C++ compiler.
shaderc_cache() {
    local version gxx files
    version=$(sed -n '/^name = "shaderc-sys"$/{n;s/^version = "\(.*\)"$/\1/p;}' "$ROOT/Cargo.lock")
    gxx=$(g++ -dumpversion 2>/dev/null | cut -d . -f 1)
    files=$(cat "$ROOT"/scripts/shaderc/* | sha256sum | cut -c 1-8)
    printf '%s\n' "$(cache_folder)/shaderc-$version-$files-$(host_triple)-g++$gxx"
}

# Sets SHADERC_CONFIG: cargo options that link the cached shaderc library instead of building it.
#
# shaderc-sys with `build-from-source` ignores SHADERC_LIB_DIR, so this overrides its build script by cargo's `links`
# key. Cargo rebuilds everything that depends on shaderc-sys when the override changes. So a target folder that has
# built the library keeps using its own, as a plain `cargo build` does; only other folders use the cache.
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
        say "using the cached shader compiler in $cache"
    else
        say "building the shader compiler (C++, once; some 90 s on two cores)"
    fi
}

# Caches the shaderc library that this target folder has built. Failing to cache it is not an error.
keep_shaderc() {
    local cache lib
    lib=$(built_shaderc) || return 0
    cache=$(shaderc_cache)
    [ ! -s "$cache/libshaderc_combined.a" ] || return 0
    # The rename is atomic, so that no other build links an incomplete file.
    if mkdir -p "$cache" && cp "$lib" "$cache/.$$.a" && mv "$cache/.$$.a" "$cache/libshaderc_combined.a"; then
        say "cached the shader compiler in $cache"
    else
        rm -f "$cache/.$$.a" || true
        say "could not cache the shader compiler in $cache (see above); the next fresh checkout will build it again"
    fi
}

# build_cargo COMMAND [ARGUMENTS]: runs cargo in the one profile that everything uses. The options follow the command,
# because `cargo --config ... clippy` does not pass them on.
build_cargo() {
    local command=$1 status=0
    shift
    use_kept_shaderc
    (cd "$ROOT" && cargo "$command" "${SHADERC_CONFIG[@]}" --release --locked "$@") || status=$?
    if [ "$status" -eq 0 ]; then keep_shaderc; fi
    return "$status"
}
