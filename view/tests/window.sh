#!/usr/bin/env bash
# Uses the window as a person does, on a display in memory: it starts, a drag takes the sponge, the picture changes, a key closes it.
# usage: view/tests/window.sh SORB, where SORB has the feature `view`. Needs Xvfb, xdotool and ImageMagick.
set -euo pipefail
sorb=$(realpath "$1")
place=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$place"' EXIT
cd "$place"
export XDG_RUNTIME_DIR=$place LP_NUM_THREADS=1

fail() {
  printf 'window: %s\n' "$1" >&2
  cat "$place"/*.printed >&2 || true
  exit 1
}

# Without a display.
if env -u DISPLAY -u WAYLAND_DISPLAY -u WAYLAND_SOCKET "$sorb" view standing 2>none.printed; then fail 'it runs without a display'; fi
grep -q 'no display was found.*' none.printed && grep -q 'sorb render SCENE FILE.png' none.printed || fail 'it does not say what is missing'

# Without `-noreset` it begins anew whenever its last client goes, and refuses those that come meanwhile.
Xvfb -displayfd 3 -noreset -screen 0 1000x700x24 3>number 2>/dev/null &
for _ in $(seq 100); do
  [ -s number ] && DISPLAY=:$(cat number) xdotool getdisplaygeometry >/dev/null 2>&1 && break
  sleep 0.1
done
DISPLAY=:$(cat number)
export DISPLAY

# The part of the screen that the picture has, as a hash of its pixels.
picture() {
  import -window root -crop 600x600+40+60 "$1.png"
  identify -format '%#' "$1.png"
}

# A picture that stays as it is.
still() {
  local before='' now
  for _ in $(seq 60); do
    now=$(picture "$1")
    [ "$now" = "$before" ] && break
    before=$now
    sleep 0.5
  done
  printf '%s' "$now"
}

# Starts the window, paused, with more arguments; waits until it shows a picture, for which it needs more than a few colours.
begin() {
  "$sorb" view standing --resolution 0.5 --paused --size 1000x700 "$@" >window.printed 2>messages.printed &
  window=$!
  for _ in $(seq 100); do
    kill -0 "$window" 2>/dev/null || fail 'it ends by itself'
    xdotool search --name '^sorb: standing' windowfocus >/dev/null 2>&1 && picture begun >/dev/null &&
      [ "$(identify -format '%k' begun.png)" -gt 1000 ] && return
    sleep 0.2
  done
  fail 'it shows no picture'
}

finish() {
  xdotool key q
  wait "$window" || fail "it closes with exit code $?"
}

# In the middle of the sponge.
drag() {
  xdotool mousemove 330 380 mousedown 1
  sleep 0.5
  for _ in $(seq 8); do
    xdotool mousemove_relative -- 0 -15
    sleep 0.1
  done
  sleep 0.5
  [ "$1" = hold ] || xdotool mouseup 1
}

for how in gpu --software; do
  flags=(--record drag.rec)
  [ "$how" = gpu ] || flags+=(--software --screenshot window.png)
  begin "${flags[@]}"
  before=$(still before)
  # The control: nothing changes by itself.
  sleep 1
  [ "$(picture again)" = "$before" ] || fail 'the picture changes without a reason'
  xdotool key space
  drag hold
  xdotool key space
  after=$(still after)
  [ "$after" != "$before" ] || fail 'a drag changes no picture'
  xdotool mouseup 1
  finish
  grep -Eq '^standing: [1-9][0-9]* frames, .* 1 grip, .*, digest [0-9a-f]{16}$' window.printed || fail "no grip ($how)"
  "$sorb" replay drag.rec --verify --quiet || fail 'the recording differs'
done
[ "$(identify -format '%wx%h' window.png)" = 1000x700 ] || fail 'no picture of the window'

# The control: without the drag there is no grip.
begin
xdotool key space
sleep 1
xdotool key space
finish
grep -Eq '^standing: [1-9][0-9]* frames, .* commands: none, digest' window.printed || fail 'commands without a drag'
printf 'window: a drag on the sponge was taken, with a GPU and without\n'
