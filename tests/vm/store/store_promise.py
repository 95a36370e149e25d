"""What a store owes after a power cut, and what of it is not there.

The lines that store_writer had put between the disk's writes say what was acknowledged when; see store_writer.cpp.
"""

import hashlib
import os
import re

DAY = re.compile(r"\d{4}-\d\d-\d\d$")


class Promise:
    """At one moment."""

    def __init__(self):
        self.settled = {}  # sequence: (done or missed, digest of SHA256SUMS, folder)
        self.pulled, self.going = set(), set()
        self.begun = 0

    def take(self, words):
        if words[0] == "begun":
            self.begun = max(self.begun, int(words[1]))
        elif words[0] in ("done", "missed"):
            self.settled[int(words[1])] = (words[0], words[2], words[3])
        elif words[0] == "pulled":
            self.pulled.add(int(words[1]))
        elif words[0] == "going":
            self.going.add(int(words[1]))

    def __str__(self):
        return f"{len(self.settled)} acknowledged, {len(self.pulled)} pulled, {len(self.going)} going"


class Marks:
    """The marks in a block log: sectors behind the file system, each with a line."""

    def __init__(self, log, first_byte):
        self.lines = []
        for at, entry in enumerate(log.entries):
            if entry.writes() and entry.sector * 512 >= first_byte:
                title, line = bytes(log.data(entry)).split(b"\0")[0].decode().splitlines()
                assert title == "dicot mark"
                self.lines.append((at, line.split(" ")))

    def before(self, cut):
        promise = Promise()
        for at, words in self.lines:
            if at < cut:
                promise.take(words)
        return promise


def sha256_of(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


def complaints_of_folder(path):
    """Whether exactly the files are there that SHA256SUMS names, each with its digest; the mark of a pull is free."""
    try:
        with open(os.path.join(path, "SHA256SUMS"), encoding="ascii") as file:
            lines = file.read().splitlines()
    except (OSError, UnicodeError) as error:
        return [f"no SHA256SUMS: {error}"]
    named = {line[66:]: line[:64] for line in lines}
    wrong = [f"{name} is missing" for name in named if not os.path.isfile(os.path.join(path, name))]
    wrong += [f"{name} is not what SHA256SUMS says" for name, digest in named.items()
              if not wrong and sha256_of(os.path.join(path, name)) != digest]
    wrong += [f"{name} is a stranger" for name in os.listdir(path)
              if name not in named and name not in ("SHA256SUMS", "PULLED")]
    if "record.json" not in named:
        wrong.append("no record.json")
    return wrong


def complaints_of_files(store, promise):
    """Before any repair: what was acknowledged is there byte by byte, and nothing in its place is torn."""
    wrong = []
    for sequence, (_, sums, folder) in promise.settled.items():
        path = os.path.join(store, folder, "SHA256SUMS")
        if sequence in promise.going and not os.path.exists(path):
            continue
        if not os.path.isfile(path):
            wrong.append(f"{folder} was acknowledged and is lost")
        elif sha256_of(path) != sums:
            wrong.append(f"{folder} is not the one that was acknowledged")
    last = max(promise.settled, default=0)
    for day in sorted(filter(DAY.match, os.listdir(store))):
        for name in sorted(os.listdir(os.path.join(store, day))):
            wrong += [f"{day}/{name}: {why}" for why in complaints_of_folder(os.path.join(store, day, name))]
            if int(name.split("_")[0]) > last + 1:
                wrong.append(f"{day}/{name}: {last} was the last to be acknowledged")
    return wrong


def complaints_of_state(said, promise):
    """After the repair, of what store_state said."""
    wrong, rows, after = [], {}, 0
    for line in said.splitlines():
        words = line.split(" ")
        if words[0] == "row":
            sequence = int(words[1])
            if sequence in rows or sequence <= max(rows, default=0):
                wrong.append(f"row {sequence} is not behind the others")
            rows[sequence] = words[2:]
        elif words[0] == "finding":
            wrong.append(f"verify after the repair: {line}")
        elif words[0] == "next":
            after = int(words[1])
    for sequence, (state, sums, folder) in promise.settled.items():
        row = rows.get(sequence)
        if row is None:
            wrong.append(f"{folder} has no row")
        elif row[1] == "pruned" and sequence in promise.going:
            pass
        elif row[0] != state or row[1] != "here" or row[3] != sums or row[4] != folder:
            wrong.append(f"{folder} is not what its row says: {row}")
        elif sequence in promise.pulled and row[2] != "pulled":
            wrong.append(f"{folder} was pulled and its row does not know")
    last = max(promise.settled, default=0)
    newest = max(rows, default=0)
    if newest > last + 1:
        wrong.append(f"a row of {newest}, and {last} was the last to be acknowledged")
    if promise.begun > newest:
        wrong.append(f"{promise.begun} was begun and has no row")
    if sorted(rows) != list(range(1, newest + 1)):
        wrong.append(f"{newest - len(rows)} of {newest} slots have no row")
    if after != newest + 1:
        wrong.append(f"after {newest} comes {after}")
    return wrong
