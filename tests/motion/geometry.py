"""Closed-form distances of moving disks, for the replay of executed motion. Shares nothing with the service."""

import math


def turned(angle):
    """The angle in (-pi, pi]."""
    wrapped = math.remainder(angle, 2.0 * math.pi)
    return math.pi if wrapped <= -math.pi else wrapped


def pose_in(action, t):
    """The pose (x, y, theta) of a robot at a time within one of its actions."""
    a, b = action["from"], action["to"]
    duration = action["t_end"] - action["t_start"]
    share = min(1.0, max(0.0, (t - action["t_start"]) / duration)) if duration > 0.0 else 1.0
    if share == 1.0:
        return b["x"], b["y"], b["theta"]
    if action["type"] == "rotate":
        return a["x"], a["y"], turned(a["theta"] + share * turned(b["theta"] - a["theta"]))
    return a["x"] + share * (b["x"] - a["x"]), a["y"] + share * (b["y"] - a["y"]), b["theta"]


def closest(p, q, t_begin, t_end):
    """The smallest distance of two points in a time both cover, and when. Each is (t0, t1, x0, y0, x1, y1), straight
    at constant speed."""
    def at(segment, t):
        t0, t1, x0, y0, x1, y1 = segment
        share = (t - t0) / (t1 - t0) if t1 > t0 else 1.0
        return x0 + share * (x1 - x0), y0 + share * (y1 - y0)

    (ax, ay), (bx, by) = at(p, t_begin), at(p, t_end)
    (cx, cy), (dx, dy) = at(q, t_begin), at(q, t_end)
    x0, y0, x1, y1 = ax - cx, ay - cy, bx - dx, by - dy
    dx, dy = x1 - x0, y1 - y0
    squared = dx * dx + dy * dy
    share = min(1.0, max(0.0, -(x0 * dx + y0 * dy) / squared)) if squared > 0.0 else 0.0
    return math.hypot(x0 + share * dx, y0 + share * dy), t_begin + share * (t_end - t_begin)


def closest_of_paths(ps, qs):
    """The smallest distance of two lists of segments in order of time, over the time both cover, and when."""
    least, when = math.inf, None
    i = j = 0
    while i < len(ps) and j < len(qs):
        begin, end = max(ps[i][0], qs[j][0]), min(ps[i][1], qs[j][1])
        if begin <= end:
            distance, t = closest(ps[i], qs[j], begin, end)
            if distance < least:
                least, when = distance, t
        if ps[i][1] <= qs[j][1]:
            i += 1
        else:
            j += 1
    return least, when


def to_rectangle(x0, y0, x1, y1, left, low, right, high):
    """The distance of a straight segment to a rectangle; 0 if it enters it."""
    def outside(x, y):
        return math.hypot(max(left - x, 0.0, x - right), max(low - y, 0.0, y - high))

    # Where the segment is inside, by the clipping of Liang and Barsky.
    begin, end = 0.0, 1.0
    for start, step, least, most in ((x0, x1 - x0, left, right), (y0, y1 - y0, low, high)):
        if step == 0.0:
            if not least <= start <= most:
                begin, end = 1.0, 0.0
            continue
        near, far = sorted(((least - start) / step, (most - start) / step))
        begin, end = max(begin, near), min(end, far)
    if begin <= end:
        return 0.0
    best = min(outside(x0, y0), outside(x1, y1))
    squared = (x1 - x0) ** 2 + (y1 - y0) ** 2
    if squared > 0.0:
        for x, y in ((left, low), (left, high), (right, low), (right, high)):
            share = min(1.0, max(0.0, ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / squared))
            best = min(best, math.hypot(x0 + share * (x1 - x0) - x, y0 + share * (y1 - y0) - y))
    return best
