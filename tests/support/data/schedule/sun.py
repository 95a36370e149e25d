#!/usr/bin/env python3
"""Writes sun.csv, which sun_test holds against dicot's sunrises: those of PyEphem (libastro, VSOP87; Debian's
python3-ephem), the sun's centre 50' below the horizon. A day is one of local mean time at the place."""
import datetime
import os

import ephem

PLACES = [("Berlin", 52.52, 13.405), ("Quito", -0.18, -78.47), ("Sydney", -33.87, 151.21), ("Apia", -13.83, -171.77),
          ("Ushuaia", -54.8, -68.3), ("Oulu", 65.01, 25.47), ("Tromso", 69.65, 18.96), ("Longyearbyen", 78.22, 15.65)]
FIRST_DAY, LAST_DAY, STEP = 0, 130 * 365, 463  # 1970 .. 2099; the step meets every season
UNIX = datetime.datetime(1970, 1, 1)


def seconds(date):
    return round((date.datetime() - UNIX).total_seconds())


def event(observer, search, noon_s):
    observer.date = ephem.Date(UNIX + datetime.timedelta(seconds=noon_s - 43200))
    observer.date = observer.next_transit(ephem.Sun())
    try:
        at = seconds(getattr(observer, search)(ephem.Sun(), use_center=True))
    except (ephem.AlwaysUpError, ephem.NeverUpError):
        return "-"
    return at if abs(at - noon_s) <= 43200 else "-"


with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "sun.csv"), "w") as out:
    out.write("place,latitude,longitude,day,rise,set; days since 1970, seconds of UTC, - for none\n")
    for name, latitude, longitude in PLACES:
        observer = ephem.Observer()
        observer.lat, observer.lon, observer.pressure, observer.horizon = str(latitude), str(longitude), 0, "-0:50"
        for day in range(FIRST_DAY, LAST_DAY, STEP):
            noon_s = (day + 0.5) * 86400 - longitude * 240
            rise, sets = (event(observer, search, noon_s) for search in ("previous_rising", "next_setting"))
            out.write(f"{name},{latitude},{longitude},{day},{rise},{sets}\n")
