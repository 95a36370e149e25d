#!/usr/bin/env python3
"""What Python's zoneinfo makes of the zones in zoneinfo/: changes.csv and slots.csv, which time_zone_test and
slot_walk_test hold against dicot's own reader. The zone files are those of tzdata 2025b (public domain); Berlin as
Debian packs it, the others as "zic -b slim" writes them, whose rules have to carry on from their last change.

    python3 zones.py            writes both again
    python3 zones.py ZONE NAME  the slots of one line of slots.csv, to find where two lists part
"""
import os
import sys
import zoneinfo
from datetime import date, datetime, timedelta, timezone

HERE = os.path.dirname(os.path.abspath(__file__))
zoneinfo.reset_tzpath([os.path.join(HERE, "zoneinfo")])
ZONES = ["Europe/Berlin", "America/New_York", "Australia/Lord_Howe", "Asia/Kathmandu", "Africa/Casablanca",
         "Pacific/Apia", "America/Sao_Paulo", "America/St_Johns", "Europe/Dublin"]
EPOCH = datetime(1970, 1, 1)

# name: at, every (minutes), from, until (minutes of the day)
SCHEDULES = {
    "morning": ([390], 0, 0, 1440),
    "night": ([0, 1, 90, 119, 120, 150, 180, 1439], 0, 0, 1440),
    "hourly": ([], 60, 0, 1440),
    "daylight": ([450], 120, 330, 1170),
    "odd": ([721], 77, 1, 1439),
}
FIRST, LAST = date(1971, 1, 1), date(2050, 1, 1)  # slots of these local days and those between


def offset_s(zone, utc_s):
    return int(datetime.fromtimestamp(utc_s, timezone.utc).astimezone(zone).utcoffset().total_seconds())


def utc_s(zone, local_s):
    """PEP 495, fold 0: the same choice as RFC 5545, 3.3.5."""
    local = (EPOCH + timedelta(seconds=local_s)).replace(tzinfo=zone, fold=0)
    return round((local - datetime(1970, 1, 1, tzinfo=timezone.utc)).total_seconds())


def changes(zone, first_s, last_s):
    step, at = 86400, first_s
    before = offset_s(zone, at)
    while at < last_s:
        if offset_s(zone, at + step) != before:
            low, high = at, at + step
            while high - low > 1:
                middle = (low + high) // 2
                low, high = (middle, high) if offset_s(zone, middle) == before else (low, middle)
            after = offset_s(zone, high)
            yield high, before, after
            before = after
            at = high
        else:
            at += step


def slots(zone, at, every, start, until):
    due = set()
    day = FIRST
    while day <= LAST:
        midnight = (day - date(1970, 1, 1)).days * 86400
        due.update(utc_s(zone, midnight + minutes * 60) for minutes in at)
        if every:
            slot, end = utc_s(zone, midnight + start * 60), utc_s(zone, midnight + until * 60)
            due.add(slot)
            while slot <= end:
                due.add(slot)
                slot += every * 60
        day += timedelta(days=1)
    return sorted(due)


def digest(numbers):
    """FNV-1a, number by number."""
    state = 0xCBF29CE484222325
    for number in numbers:
        state = ((state ^ number) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return state


def main():
    if len(sys.argv) == 3:
        for due in slots(zoneinfo.ZoneInfo(sys.argv[1]), *SCHEDULES[sys.argv[2]]):
            print(due, datetime.fromtimestamp(due, timezone.utc).isoformat())
        return
    with open(os.path.join(HERE, "changes.csv"), "w") as out:
        out.write("zone,change,before,after,five local seconds and the UTC ones that they mean; all seconds\n")
        for name in ZONES:
            zone = zoneinfo.ZoneInfo(name)
            for at, before, after in changes(zone, 0, 4102444800):
                low, high = at + min(before, after), at + max(before, after)
                probes = [low - 1, low, (low + high) // 2, high - 1, high]
                means = [f"{probe - at},{utc_s(zone, probe) - at}" for probe in probes]  # relative to the change
                out.write(f"{name},{at},{before},{after},{','.join(means)}\n")
    with open(os.path.join(HERE, "slots.csv"), "w") as out:
        out.write("zone,schedule,count,first,last,digest\n")
        for name in ZONES:
            for schedule, words in SCHEDULES.items():
                due = slots(zoneinfo.ZoneInfo(name), *words)
                out.write(f"{name},{schedule},{len(due)},{due[0]},{due[-1]},{digest(due)}\n")


main()
