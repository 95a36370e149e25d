#!/usr/bin/env python3
"""Replays the power cuts that a disk's log allows, and judges what is left of the store on it.

    crash_test.py IMAGE LOG --file-system BYTES --state STORE_STATE [--seed S] [--states N] [--only S/K] [--careless PERCENT]

IMAGE is the disk before the machine started, LOG what blklogwrites wrote, BYTES where the file system ends and the marks of
store_writer begin. For each state: the disk is put together (crash_state.py), e2fsck replays the journal and mends,
debugfs copies the store out, its files are hashed here, and store_state repairs it and says what it then holds.

Promised is what was acknowledged before the cut. With --careless at least so many
of the states must break the promise: a store that leaves out syncs is found out. --only replays the state of one id and leaves its disk and its files beside LOG.
"""

import argparse
import collections
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

from block_log import SECTOR, BlockLog
from crash_state import CrashState, Disk
from store_promise import Marks, complaints_of_files, complaints_of_state


def mended(disk, folder):
    """Copies the store out of the disk, after what a board does before it mounts a card. Gives complaints."""
    check = subprocess.run(["e2fsck", "-fy", disk], capture_output=True, text=True, check=False)
    if check.returncode & ~3:
        return [f"e2fsck cannot mend the file system: {check.stdout[-200:]!r}"]
    copied = subprocess.run(["debugfs", "-R", f"rdump /store {folder}", disk], capture_output=True, text=True, check=False)
    if not os.path.isdir(os.path.join(folder, "store")):
        return [f"debugfs finds no store: {copied.stderr[-200:]!r}"]
    return []


def complaints(disk, promise, checker, folder, starts):
    """Of this disk; `starts` counts what the store's start-up had to do."""
    wrong = mended(disk, folder)
    if wrong:
        return wrong
    store = os.path.join(folder, "store")
    wrong = complaints_of_files(store, promise)
    said = subprocess.run([checker, store], capture_output=True, text=True, errors="replace", check=False)
    if said.returncode:
        return wrong + [f"store_state ends with {said.returncode}: {said.stdout[-300:]!r}"]
    first = said.stdout.split("\n")[0].split(" ")[1:]
    starts.update(word for word, count in zip(first[::2], first[1::2]) if int(count))
    return wrong + complaints_of_state(said.stdout, promise)


def journal_of(image):
    """The sectors that are the file system's journal."""
    said = subprocess.run(["debugfs", "-R", "stat <8>", image], capture_output=True, text=True, check=False).stdout
    blocks = re.findall(r"\(\d+-\d+\):(\d+)-(\d+)", said)
    return [range(int(first) * 8, (int(last) + 1) * 8) for first, last in blocks]


def print_costs(log, marks, image, file_system):
    """What snapshots cost the disk, from the mark before "begun", whose folder is made durable first, to "done"."""
    journal = journal_of(image)
    lines = [(0, ["opened"])] + marks.lines
    done = payload = written = of_journal = flushes = 0
    for (before, first), (_, second), (at, third) in zip(lines, lines[1:], lines[2:]):
        if first[0] not in ("done", "missed", "pulled") or second[0] != "begun" or third[0] != "done":
            continue  # the first of a run, a miss, or one behind a pruning
        done += 1
        payload += int(third[4])
        for entry in log.entries[before:at]:
            flushes += entry.is_flush()
            if entry.writes() and entry.sector * SECTOR < file_system:
                written += entry.sectors * SECTOR
                of_journal += entry.sectors * SECTOR * any(entry.sector in part for part in journal)
    everything = sum(e.sectors * SECTOR for e in log.entries if e.writes() and e.sector * SECTOR < file_system)
    print(f"    {done} snapshots of {payload / done / 1024:.0f} KiB: each {written / done / 1024:.0f} KiB written to the disk, "
          f"{of_journal / done / 1024:.0f} of them to the journal, and {flushes / done:.1f} flushes; the whole run, with "
          f"misses, pulls and pruning: {everything / 1024:.0f} KiB")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("image")
    parser.add_argument("log")
    parser.add_argument("--file-system", type=int, required=True)
    parser.add_argument("--state", required=True, help="the program store_state")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--states", type=int, default=200)
    parser.add_argument("--only")
    parser.add_argument("--careless", type=int, metavar="PERCENT")
    parser.add_argument("--name", default="states")
    words = parser.parse_args()

    log = BlockLog(words.log)
    marks = Marks(log, words.file_system)
    if len(marks.lines) < 10:
        print(f"FAILED  {words.name}: {len(marks.lines)} marks in {words.log}: the writer did not run")
        return 1
    last = marks.lines[-1][0] + 1
    wanted = [words.only.split("/")] if words.only else [(words.seed, k) for k in range(words.states)]
    states = [CrashState(log, int(seed), int(number), last) for seed, number in wanted]
    broken, unflushed, torn, started = 0, 0, 0, time.time()
    starts = collections.Counter()
    # In memory: a disk takes longer to delete a state's files than all else takes.
    within = "/dev/shm" if os.access("/dev/shm", os.W_OK) and not words.only else os.path.dirname(os.path.abspath(words.log))
    folder = tempfile.mkdtemp(prefix="dicot-states.", dir=within)
    try:
        disk = Disk(log, words.image, folder)
        for state in sorted(states, key=lambda s: s.durable):
            image = os.path.join(folder, "state.img")
            out = os.path.join(folder, "out")
            os.mkdir(out)
            disk.at(state, image)
            promise = marks.before(state.cut)
            wrong = complaints(image, promise, words.state, out, starts)
            broken += bool(wrong)
            unflushed += state.cut > state.durable
            torn += state.torn > 0
            if words.only or (wrong and not words.careless):
                print(f"    state {state.name}, {state}, {promise}:")
                for line in wrong[:5] or ["nothing is wrong"]:
                    print(f"        {line}")
            if words.only:
                print(f"    left in {folder}")
                return bool(wrong)
            shutil.rmtree(out)
    finally:
        if not words.only:
            shutil.rmtree(folder, ignore_errors=True)

    print(f"    {words.name}: {len(states)} states of seed {words.seed}, of {len(log.entries)} requests with "
          f"{len(marks.lines)} marks; {unflushed} with unflushed writes, {torn} with torn ones; "
          f"{broken} broke the promise; {time.time() - started:.0f} s")
    if not words.careless:
        print(f"    start-up: finished a snapshot in {starts['finished']} states, recorded an interrupted one in "
              f"{starts['interrupted']}, added rows in {starts['rows']}, made the catalogue in {starts['new']}")
        print_costs(log, marks, words.image, words.file_system)
    # Cuts before the first acknowledgement, and just behind a write-back of the system's own, break nothing.
    fine = broken * 100 >= len(states) * words.careless if words.careless else broken == 0
    verdict = "ok     " if fine else "FAILED "
    print(f"{verdict} vm {words.name}")
    return 0 if fine else 1


if __name__ == "__main__":
    sys.exit(main())
