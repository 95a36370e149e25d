#!/usr/bin/env python3
"""The replay on logs that are written here by hand: what lasts, what may be lost, what is refused."""

import os
import struct
import tempfile
import unittest

from block_log import DISCARD, FLUSH, FUA, MAGIC, SECTOR, BadLog, BlockLog
from crash_state import CrashState, Disk


def log_of(path, *entries, cut=0):
    """Entries are (flags, sector, letters): a letter fills a sector."""
    with open(path, "wb") as log:
        log.write(struct.pack("<QQQI", MAGIC, 1, len(entries), SECTOR).ljust(SECTOR, b"\0"))
        for flags, sector, letters in entries:
            log.write(struct.pack("<QQQQ", sector, len(letters), flags, 0).ljust(SECTOR, b"\0"))
            if not flags & DISCARD:
                log.write(b"".join(letter.encode() * SECTOR for letter in letters))
        log.truncate(log.tell() - cut)


class Replay(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.log = self.path("log")
        with open(self.path("image"), "wb") as image:
            image.write(b"." * (8 * SECTOR))

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def disks(self, end, numbers=200):
        """What all states hold, a letter a sector; a sector that was torn inside would be two."""
        log = BlockLog(self.log)
        found = {}
        disk = Disk(log, self.path("image"), self.folder.name)
        for state in sorted((CrashState(log, 7, k, end) for k in range(numbers)), key=lambda s: s.durable):
            disk.at(state, self.path("state"))
            with open(self.path("state"), "rb") as file:
                data = file.read()
            sectors = [set(data[at:at + SECTOR]) for at in range(0, len(data), SECTOR)]
            self.assertTrue(all(len(sector) == 1 for sector in sectors))
            found.setdefault(state.cut, set()).add("".join(chr(min(s)) if min(s) else "0" for s in sectors))
        return found

    def test_what_was_flushed_is_there_and_the_rest_in_any_part(self):
        log_of(self.log, (0, 0, "a"), (FLUSH, 0, ""), (0, 1, "b"), (0, 2, "c"))
        found = self.disks(4)
        self.assertEqual(found[0], {"........"})
        self.assertEqual(found[1], {"........", "a......."})
        self.assertEqual(found[2], {"a......."})
        self.assertEqual(found[4], {"a.......", "ab......", "a.c.....", "abc....."})

    def test_a_write_tears_between_sectors_alone(self):
        log_of(self.log, (0, 4, "xyz"))
        found = self.disks(1)[1]
        self.assertTrue({"........", "....xyz."} < found)
        self.assertTrue(all(letter in ("." + "....xyz."[at]) for disk in found for at, letter in enumerate(disk)), found)

    def test_a_forced_write_is_never_lost_and_nothing_before_it_lasts_for_it(self):
        log_of(self.log, (0, 0, "a"), (FUA, 1, "b"))
        self.assertEqual(self.disks(2)[2], {".b......", "ab......"})

    def test_a_discarded_range_may_be_gone(self):
        log_of(self.log, (DISCARD, 2, "..."))
        self.assertEqual(self.disks(1)[1], {"........", "..000..."})

    def test_a_state_is_the_same_each_time(self):
        log_of(self.log, *[(0, k % 8, "q") for k in range(30)])
        log = BlockLog(self.log)
        first, again = (CrashState(log, 3, 5, 30) for _ in range(2))
        self.assertEqual((str(first), first.kept), (str(again), again.kept))
        self.assertNotEqual({str(CrashState(log, 3, k, 30)) for k in range(9)}, {str(first)})

    def test_what_is_no_log_is_refused(self):
        log_of(self.log, (0, 0, "ab"), cut=1)
        for name in (self.log, self.path("image"), os.devnull):
            with self.assertRaises(BadLog):
                BlockLog(name)


if __name__ == "__main__":
    result = unittest.main(exit=False, verbosity=0).result
    print("ok      vm store.replay_of_logs_made_by_hand" if result.wasSuccessful() and result.testsRun else
          "FAILED  vm store.replay_of_logs_made_by_hand")
    raise SystemExit(0 if result.wasSuccessful() else 1)
