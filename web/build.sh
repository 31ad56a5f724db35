#!/usr/bin/env bash
# Builds the page: a folder of static files, web/dist.
#   web/build.sh            builds it
#   web/build.sh --serve    builds it and serves it on this machine
#   web/build.sh --module   builds the module for WebAssembly alone
# Needs node with npm, and a compiler for wasm32-unknown-unknown: that of rustup, or Debian's packages, which are unpacked into a cache
# beside it and not installed.
set -euo pipefail
cd "$(dirname "$0")"
here=$PWD
# The compiler where rustup has none for the target. Debian revises its packages: the version of Rust is what is pinned.
debian_rust=1.96.0
most_bytes=1600000
debs=$(mktemp -d)
trap 'rm -rf "$debs"' EXIT
target=${CARGO_TARGET_DIR:-$here/../target}/web
cache=${SORB_WEB_COMPILER:-${XDG_CACHE_HOME:-$HOME/.cache}/sorb-web-$debian_rust}
# simd128 alone: what is relaxed in the other extension differs from machine to machine.
export CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS='-C target-feature=+simd128'

missing() {
  printf 'web/build.sh: %s\n' "$@" >&2
  exit 3
}

has_rustup_target() {
  local root
  root=$(rustc --print sysroot 2>/dev/null) && [ -d "$root/lib/rustlib/wasm32-unknown-unknown/lib" ]
}

no_compiler() {
  missing "$1" 'a compiler for wasm32-unknown-unknown is needed:' '  rustup target add wasm32-unknown-unknown' \
    "or Debian's packages rustc-web, cargo-web and rust-web-src of version $debian_rust"
}

# Names that a package depends on, by a pattern.
dependencies() {
  apt-cache depends "$1" | sed -n "s/.*Depends: \($2\)\$/\1/p" | sort -u
}

unpack_compiler() {
  local std llvm git packages package found
  command -v apt-get >/dev/null && command -v dpkg >/dev/null || no_compiler 'neither rustup has the target nor is this Debian'
  found=$(apt-cache policy rustc-web 2>/dev/null | sed -n 's/ *Candidate: //p')
  if [ "${found%%[+-]*}" != "$debian_rust" ]; then
    apt-get update -qq || true
    found=$(apt-cache policy rustc-web 2>/dev/null | sed -n 's/ *Candidate: //p')
  fi
  [ "${found%%[+-]*}" = "$debian_rust" ] || no_compiler "the package rustc-web has version ${found:-none}, not $debian_rust"
  std=$(dependencies libstd-rust-web-dev 'libstd-rust-web-[0-9.]*')
  llvm=$(dependencies "$std" 'libllvm[0-9]*')
  git=$(dependencies cargo-web 'libgit2-[0-9.]*')
  packages=(rustc-web cargo-web rust-web-src libstd-rust-web-dev "$std" "$llvm" "lld-${llvm#libllvm}" "$git")
  # What libgit2 needs and a small machine may lack.
  mapfile -t -O "${#packages[@]}" packages < <(dependencies "$git" 'lib\(mbed\|http\|ssh\|llhttp\)[^ ]*')
  (cd "$debs" && apt-get download -qq "${packages[@]}") || no_compiler "Debian's packages cannot be downloaded"
  rm -rf "$cache.part" "$cache"
  mkdir -p "$cache.part"
  for package in "$debs"/*.deb; do dpkg -x "$package" "$cache.part"; done
  mv "$cache.part" "$cache"
}

build_module() {
  local options=(build --locked --release --target wasm32-unknown-unknown --target-dir "$target")
  if has_rustup_target; then
    cargo "${options[@]}"
  else
    [ -x "$cache/usr/bin/rustc" ] || unpack_compiler
    # Debian has the source of std, which is built here. Its cargo asks for no toolchain file, which only rustup reads.
    LD_LIBRARY_PATH=$(echo "$cache"/usr/lib/*-linux-gnu) RUSTC="$cache/usr/bin/rustc" RUSTC_BOOTSTRAP=1 \
      CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=$(echo "$cache"/usr/lib/llvm-*/bin/wasm-ld) \
      "$cache/usr/bin/cargo" "${options[@]}" -Zbuild-std=std,panic_abort
  fi
  mkdir -p dist
  cp "$target/wasm32-unknown-unknown/release/sorb_web.wasm" dist/sorb.wasm
}

build_page() {
  command -v npm >/dev/null || missing 'node 20 or newer with npm is needed for the page'
  [ node_modules/.package-lock.json -nt package-lock.json ] || npm ci || missing 'the packages of npm cannot be installed'
  npm run --silent check
  npm run --silent bundle
}

small_enough() {
  local bytes=0 file
  for file in dist/*; do bytes=$((bytes + $(gzip -9 --to-stdout "$file" | wc -c))); done
  printf 'web/dist: %d bytes gzipped\n' "$bytes"
  [ "$bytes" -le "$most_bytes" ] || { printf 'more than %d bytes\n' "$most_bytes" >&2; return 1; }
}

build_module
[ "${1:-}" != --module ] || exit 0
build_page
small_enough
[ "${1:-}" != --serve ] || node serve.mjs
