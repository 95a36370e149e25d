"""What a disk may hold when its power goes: everything up to the last flush, and any part of what came after it."""

import os
import random

from block_log import SECTOR


class CrashState:
    """State number `number` of `seed`: the same for the same log. Drawn are the cut, which of the writes after the last
    flush before it are on the disk, and which of these are torn. Entries from `end` on never happened."""

    def __init__(self, log, seed, number, end):
        dice = random.Random(f"{seed}/{number}")
        entries = log.entries
        self.name = f"{seed}/{number}"
        # Half of the cuts fall anywhere, half around a flush, where an order that is wrong shows; before it most is open.
        self.cut = dice.randint(0, end)
        if dice.random() < 0.5:
            flushes = [at for at in range(end) if entries[at].is_flush()]
            if flushes:
                self.cut = dice.choice(flushes) + dice.choice((0, 0, 0, 1))
        self.durable = max((at + 1 for at in range(self.cut) if entries[at].is_flush()), default=0)
        share = dice.choice((0.0, 0.2, 0.5, 0.8, 1.0))
        torn_share = dice.choice((0.0, 0.3, 0.6))
        self.kept = []  # (entry, sectors that are there or None for all)
        self.lost = self.torn = 0
        for at in range(self.durable, self.cut):
            entry = entries[at]
            if not entry.writes() and not entry.discards():
                continue
            if not entry.lasts() and dice.random() >= share:
                self.lost += 1
            elif entry.writes() and not entry.lasts() and dice.random() < torn_share:
                self.kept.append((entry, [s for s in range(entry.sectors) if dice.random() < 0.5]))
                self.torn += 1
            else:
                self.kept.append((entry, None))

    def __str__(self):
        return (f"cut at {self.cut}, flushed to {self.durable}, {len(self.kept) - self.torn} writes kept, "
                f"{self.torn} torn, {self.lost} lost")


def apply(log, entry, disk, sectors=None):
    """Writes an entry, or some of its sectors, to a file that is a disk. A discarded range holds zeros: any content is
    allowed, and a file system must not care."""
    if entry.discards():
        left = entry.sectors * SECTOR
        disk.seek(entry.sector * SECTOR)
        while left:
            part = min(left, 1 << 20)
            disk.write(bytes(part))
            left -= part
        return
    if not entry.writes():
        return
    data = log.data(entry)
    if sectors is None:
        disk.seek(entry.sector * SECTOR)
        disk.write(data)
        return
    for sector in sectors:
        disk.seek((entry.sector + sector) * SECTOR)
        disk.write(data[sector * SECTOR:(sector + 1) * SECTOR])


class Disk:
    """The disk as far as it is durable; moves forward alone, so states are to be asked for in the order of `durable`."""

    def __init__(self, log, image, folder):
        self.log, self.applied = log, 0
        self.path = os.path.join(folder, "durable.img")
        copy(image, self.path)

    def at(self, state, path):
        """Makes `path` the disk of this state."""
        with open(self.path, "r+b") as disk:
            for entry in self.log.entries[self.applied:state.durable]:
                apply(self.log, entry, disk)
        self.applied = max(self.applied, state.durable)
        copy(self.path, path)
        with open(path, "r+b") as disk:
            for entry, sectors in state.kept:
                apply(self.log, entry, disk, sectors)


def copy(source, target):
    """Only what is not a hole."""
    with open(source, "rb") as read, open(target, "wb") as write:
        size = os.fstat(read.fileno()).st_size
        write.truncate(size)
        at = 0
        while at < size:
            try:
                begin = os.lseek(read.fileno(), at, os.SEEK_DATA)
            except OSError:
                break
            at = os.lseek(read.fileno(), begin, os.SEEK_HOLE)
            while begin < at:
                data = os.pread(read.fileno(), min(at - begin, 1 << 20), begin)
                begin += os.pwrite(write.fileno(), data, begin)
