#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Flies what scripts/models flies, and compares with what the headers of examples/models say of their flights.
#   shipped_models.sh ROOT PINNQUAD SHIPPED_MODELS WORK
set -euo pipefail
root=$1 pinnquad=$2 shipped=$3 work=$4
mkdir -p "$work"
"$root/scripts/models" --flights "$pinnquad" "$work"
"$shipped" "$work/flight.csv" "$work/crazyflie_flight.csv"
