#!/usr/bin/env python3
"""What a snapshot costs, and how long a battery lasts.

  energy.py measure DICOT DATA     processor time, wall time and bytes of a snapshot, of recorded pictures
  energy.py table                  days on a battery, from the figures and constants below, as Markdown
  energy.py check README           whether that table stands in the README: exit code 1 if not

DATA holds calibration-opencv (real pairs, 640 x 480) and rig-dev (rendered, 1280 x 720). Where the constants come from is
told in platform/app/power/README.md; "e" marks an estimate.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

# What `measure` gave: processor seconds (AVX2) and bytes of one snapshot.
MEASURED = {"640 x 480 x 64": (1.8, 489_250), "1280 x 720 x 128": (9.6, 1_787_407)}

# Watts at 5 V: idle, all cores at work, suspended, off; seconds from the alarm until the program runs: resumed, booted;
# cores; how many times slower one of them is than the one that was measured on. None: the board cannot.
BOARDS = {
    "Raspberry Pi Zero 2 W": dict(idle=0.60, busy=2.4, suspend=None, off=0.05, resume=0, boot=40, cores=4, slower=20),
    "Raspberry Pi 5": dict(idle=2.8, busy=7.5, suspend=None, off=0.02, resume=0, boot=20, cores=4, slower=3),
    "i.MX 8M Mini": dict(idle=1.30, busy=3.5, suspend=0.095, off=0.01, resume=3, boot=25, cores=4, slower=11),
}
CAMERAS_ON_W = 2.0        # both, streaming (e)
CAMERAS_ASLEEP_W = 0.025  # both: 2.5 mA each, USB 2.0 clause 7.2.3
CAMERAS_ON_S = 15         # warm-up and burst (e)
PARALLEL = 0.9            # of all cores, while pictures are matched (e)
BATTERY_WH = 12 * 20
USABLE = 0.8              # of the battery (e)
CONVERTER = 0.88          # 12 V to 5 V (e)
SLOTS = 8


def day_wh(board, cpu_s, way):
    """Energy of a day at 5 V; None: the board cannot do it."""
    rest_w = board[way]
    if rest_w is None:
        return None
    waking_s = {"idle": 0, "suspend": board["resume"], "off": board["boot"]}[way]
    work_s = cpu_s * board["slower"] / (board["cores"] * PARALLEL)
    slot_s = waking_s + CAMERAS_ON_S + work_s
    slot_ws = (waking_s * (board["idle"] + board["busy"]) / 2  # booting keeps about half of the cores busy (e)
               + CAMERAS_ON_S * (board["idle"] + CAMERAS_ON_W) + work_s * board["busy"])
    asleep_w = 0 if way == "off" else CAMERAS_ASLEEP_W
    return (SLOTS * slot_ws + (86400 - SLOTS * slot_s) * (rest_w + asleep_w)) / 3600


def table():
    lines = ["| board | pictures | matching etc. | idle | suspend | off |", "|---|---|---|---|---|---|"]
    for name, board in BOARDS.items():
        for size, (cpu_s, _) in MEASURED.items():
            work_s = cpu_s * board["slower"] / (board["cores"] * PARALLEL)
            cells = [name, size, f"{work_s:.0f} s"]
            for way in ("idle", "suspend", "off"):
                wh = day_wh(board, cpu_s, way)
                days = None if wh is None else BATTERY_WH * USABLE * CONVERTER / wh
                cells.append("-" if days is None else f"{days:.0f} days ({wh:.1f} Wh)")
            lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def cases(data, folder):
    """Name, configuration: the recorded pictures of each in a folder of their own."""
    opencv, rig = os.path.join(data, "calibration-opencv"), os.path.join(data, "rig-dev", "plants")
    plant = os.path.join(rig, "p1_epipremnum")
    for name, left, right, rig_file, size, reach in (
            ("small", f"{opencv}/left01.jpg", f"{opencv}/right01.jpg", "rig.yaml", (640, 480), (455, 1000)),
            ("wide", f"{plant}/overcast_left.jpg", f"{plant}/overcast_right.jpg", f"{rig}/gt_calib.yml", (1280, 720), (404, 1690))):
        pairs = os.path.join(folder, name)
        os.mkdir(pairs)
        shutil.copy(left, os.path.join(pairs, "left_01.jpg"))
        shutil.copy(right, os.path.join(pairs, "right_01.jpg"))
        config = os.path.join(folder, name + ".toml")
        with open(config, "w", encoding="utf-8") as file:
            file.write(f"[cameras]\nleft = 'replay:{name}'\nright = 'replay:{name}'\nwidth = {size[0]}\nheight = {size[1]}\n"
                       f"[rig]\nfile = '{rig_file}'\nnear_mm = {reach[0]}\nfar_mm = {reach[1]}\n")
        yield name, config


def measure(dicot, data):
    data = os.path.abspath(data)
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([dicot, "calibrate", "--images", os.path.join(data, "calibration-opencv"), "--squares", "10x7",
                        "--square-mm", "30", "-o", os.path.join(folder, "rig.yaml")], check=True, stdout=subprocess.DEVNULL)
        print("pictures            processor time   wall time   bytes written   points")
        for name, config in cases(data, folder):
            best = None
            for _ in range(3):
                before, began = os.times(), time.monotonic()
                done = subprocess.run([dicot, "snap", "--config", config, "-o", os.path.join(folder, "store"), "--json"],
                                      check=True, stdout=subprocess.PIPE)
                wall, after = time.monotonic() - began, os.times()
                cpu = after.children_user + after.children_system - before.children_user - before.children_system
                best = min(best or (cpu, wall), (cpu, wall))
            record = json.loads(done.stdout)
            cloud = record["cloud"]
            size = f'{cloud["width"]} x {cloud["height"]} x {cloud["disparities"]}'
            print(f'{size:18s}  {best[0]:12.2f} s  {best[1]:8.2f} s  {record["bytes_written"]:14d}  {cloud["points"]:7d}')


def main(words):
    if len(words) == 3 and words[0] == "measure":
        measure(words[1], words[2])
    elif words == ["table"]:
        print(table())
    elif len(words) == 2 and words[0] == "check":
        with open(words[1], encoding="utf-8") as file:
            if table() not in file.read():
                print(f"energy.py: {words[1]} has another table; write what `energy.py table` prints", file=sys.stderr)
                return 1
    else:
        print(__doc__, file=sys.stderr)
        return 64
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
