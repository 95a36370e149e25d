"""What a disk was told, in order: the log that QEMU's blklogwrites keeps, in the format of the kernel's dm-log-writes.

The file begins with a block that says magic, version, number of entries and block size, little-endian. Each entry is one
block (sector, sectors, flags, bytes of a mark) with its data behind it. Sectors have 512 bytes.
"""

import struct

SECTOR = 512
MAGIC = 0x6A736677736872
FLUSH, FUA, DISCARD, MARK = 1, 2, 4, 8
_SUPER = struct.Struct("<QQQI")
_ENTRY = struct.Struct("<QQQQ")


class BadLog(Exception):
    """The file is no such log, or ends in the middle of an entry."""


class Entry:
    """One request: `data_at` is where its bytes stand in the log."""

    __slots__ = ("sector", "sectors", "flags", "data_at")

    def __init__(self, sector, sectors, flags, data_at):
        self.sector, self.sectors, self.flags, self.data_at = sector, sectors, flags, data_at

    def is_flush(self):
        return bool(self.flags & FLUSH)

    def writes(self):
        return self.sectors > 0 and not self.flags & (DISCARD | MARK)

    def discards(self):
        return self.sectors > 0 and bool(self.flags & DISCARD)

    def lasts(self):
        """Force unit access: what it writes is on the disk when it is done."""
        return bool(self.flags & FUA)


class BlockLog:
    def __init__(self, path):
        with open(path, "rb") as file:
            self.bytes = memoryview(file.read())
        if len(self.bytes) < SECTOR:
            raise BadLog(f"{path}: too short for a block log")
        magic, version, count, size = _SUPER.unpack_from(self.bytes)
        if magic != MAGIC or version != 1 or size < SECTOR or size % SECTOR:
            raise BadLog(f"{path}: no block log of dm-log-writes, version 1")
        self.entries = []
        at = size
        for number in range(count):
            if at + size > len(self.bytes):
                raise BadLog(f"{path}: ends in entry {number} of {count}")
            sector, sectors, flags, mark_bytes = _ENTRY.unpack_from(self.bytes, at)
            at += size
            self.entries.append(Entry(sector, sectors, flags, at))
            if flags & MARK:
                at += -(-mark_bytes // size) * size
            elif not flags & DISCARD:
                at += sectors * SECTOR
            if at > len(self.bytes):
                raise BadLog(f"{path}: ends in entry {number} of {count}")

    def data(self, entry):
        return self.bytes[entry.data_at:entry.data_at + entry.sectors * SECTOR]
