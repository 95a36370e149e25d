#!/bin/sh
# The description (device tree) of the emulated board with what it leaves out: its processor can stand by. Without a driver of such
# a state the kernel lets its monotonic clock go on while the system is suspended, and every watchdog of systemd barks.
#
#   sh tests/vm/sleeper.sh OUTPUT.dtb      the machine of run.sh
set -eu
output=${1:?sleeper.sh: name the file to make}
for program in qemu-system-aarch64 fdtput; do
    command -v $program >/dev/null && continue
    echo "sleeper.sh: $program is missing; install the packages qemu-system-arm and device-tree-compiler" >&2
    exit 69
done
qemu-system-aarch64 -M virt,dumpdtb="$output" -cpu cortex-a72 -m 512 -nodefaults -display none -nic none >/dev/null 2>&1
# The binding is Linux's Documentation/devicetree/bindings/cpu/idle-states.yaml; the parameter is PSCI's CPU_SUSPEND's: standby.
cpu=/cpus/cpu@0 states=/cpus/idle-states handle=0x00009001
fdtput -p -c "$output" $states/standby
fdtput -t s "$output" $states entry-method psci
fdtput -t s "$output" $states/standby compatible arm,idle-state
fdtput -t x "$output" $states/standby arm,psci-suspend-param 1
fdtput -t i "$output" $states/standby entry-latency-us 10
fdtput -t i "$output" $states/standby exit-latency-us 10
fdtput -t i "$output" $states/standby min-residency-us 20
fdtput -t x "$output" $states/standby phandle $handle
fdtput -t s "$output" $cpu enable-method psci
fdtput -t x "$output" $cpu cpu-idle-states $handle
