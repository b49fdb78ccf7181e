#!/usr/bin/env bash
# Installs, on an Ubuntu machine of GitHub's, what tests skip when it is absent: OpenGL, Icarus Verilog, a browser; and
# ccache. Chrome and its driver are on these machines already; the tests look for `chromium`.
set -euo pipefail
sudo apt-get update --quiet
sudo apt-get install --yes --quiet --no-install-recommends ccache iverilog libegl1 libgl1
if ! command -v chromium >/dev/null && chrome=$(command -v google-chrome); then
  sudo ln -s "$chrome" /usr/local/bin/chromium
fi
