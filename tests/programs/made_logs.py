# SPDX-License-Identifier: MIT
"""Logs that tests write: a flight in closed form whose motors are LAG_S ahead of the motion that they cause, and files in
the formats of several vehicles. Nothing of the readers is used."""
import json
import re
import struct
import zlib
from math import cos, degrees, sin, sqrt
from pathlib import Path

from conftest import SOURCE

GRAVITY, LAG_S, STEP_S = 9.80665, 0.04, 1e-4
# a flight's CSV as fly writes it, read as a table
FLIGHT_MAPPING = """world = "ned"
body = "frd"
time = { column = "t", unit = "s" }
attitude = { euler = ["roll", "pitch", "yaw"] }
body_rates = { columns = ["w_x", "w_y", "w_z"] }
velocity = { columns = ["v_bx", "v_by", "v_bz"], axes = "body" }
altitude = { columns = "altitude" }
motors = { columns = ["u1", "u2", "u3", "u4"], numbers = "thrust", order = "px4" }
"""


# the flight: NED and FRD


def angles(t):
    """Roll, pitch, yaw."""
    return (0.25 * sin(1.7 * t) + 0.08 * sin(7.1 * t + 1), 0.2 * sin(1.3 * t + 0.5) + 0.07 * sin(8.3 * t),
            0.3 * sin(0.7 * t) + 0.05 * sin(5.3 * t))


def slope(function, t, step):
    return [(after - before) / (2 * step) for after, before in zip(function(t + step), function(t - step))]


def rates(t):
    """Body rates."""
    phi, theta, _ = angles(t)
    d_phi, d_theta, d_psi = slope(angles, t, STEP_S)
    return (d_phi - d_psi * sin(theta), d_theta * cos(phi) + d_psi * cos(theta) * sin(phi),
            -d_theta * sin(phi) + d_psi * cos(theta) * cos(phi))


def to_body(angles, vector):
    """From NED to FRD."""
    (sr, sp, sy), (cr, cp, cy) = map(sin, angles), map(cos, angles)
    n, e, d = vector
    return (cp * cy * n + cp * sy * e - sp * d,
            (sr * sp * cy - cr * sy) * n + (sr * sp * sy + cr * cy) * e + sr * cp * d,
            (cr * sp * cy + sr * sy) * n + (cr * sp * sy - sr * cy) * e + cr * cp * d)


def specific_force(t):
    return to_body(angles(t), (1.8 * cos(0.9 * t), -0.9 * sin(0.6 * t),
                               0.4 * cos(0.8 * t) + 1.5 * sin(4.1 * t) - GRAVITY))


def velocity(t):
    return 2 * sin(0.9 * t), 1.5 * cos(0.6 * t), 0.5 * sin(0.8 * t) - 1.5 / 4.1 * cos(4.1 * t)


def position(t):
    return -2 / 0.9 * cos(0.9 * t), 2.5 * sin(0.6 * t), -20 - 0.5 / 0.8 * cos(0.8 * t) - 1.5 / 4.1**2 * sin(4.1 * t)


def quaternion(t):
    """w, x, y, z, FRD to NED."""
    (sr, sp, sy), (cr, cp, cy) = map(sin, (a / 2 for a in angles(t))), map(cos, (a / 2 for a in angles(t)))
    return cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy


def quaternion_enu_flu(t):
    """x, y, z, w, FLU to ENU: (0, s, s, 0) q (0, 1, 0, 0)."""
    w, a, b, e = quaternion(t)
    s = sqrt(0.5)
    w1, a1, b1, e1 = -s * a - s * b, s * w + s * e, s * w - s * e, s * b - s * a
    return w1, e1, -b1, -a1


def commands_at(t):
    """Front right, rear left, front left, rear right, 0..1."""
    c = -specific_force(t + LAG_S)[2] / 20
    kx, ky, kz = (dot / size for dot, size in zip(slope(rates, t + LAG_S, 1e-3), (160, 160, 80)))
    return c - kx + ky + kz, c + kx - ky + kz, c + kx + ky - kz, c - kx - ky - kz


# what an import makes of a log


def imported(pinnquad, log, *words, out=None):
    """What it says; the dataset is a folder named as the log, or as said."""
    out = out or Path(log).stem
    return pinnquad("import", log, "--out", out, *words).out


def facts(folder):
    return json.loads(Path(folder, "dataset.json").read_text())


def flight_in(folder):
    (flight,) = facts(folder)["flights"]
    return Path(folder, flight["file"])


def numbers(path, *names, clock="t", ticks=1):
    """Rows of time and those columns; what is no number is NaN."""
    with open(path) as file:
        header = re.split(r",", file.readline().strip())
        places = [header.index(name) for name in (clock, *names)]
        rows = [[float(cells[at] or "nan") for at in places] for cells in (line.strip().split(",") for line in file)]
    return [[row[0] / ticks, *row[1:]] for row in rows]


def errors(truth, flight, late_s=0.0):
    """Rows compared, and the root mean squares of the difference in each column: of a flight and what a reference says
    `late_s` before its times, by lines between the reference's rows."""
    at, count, sums = 0, 0, [0.0] * (len(flight[0]) - 1)
    for time, *values in flight:
        now = time - late_s
        while at < len(truth) - 2 and truth[at + 1][0] <= now:
            at += 1
        begin, end = truth[at][0], truth[at + 1][0]
        if now < begin - 1e-6 or now > end + 1e-6 or end - begin > 0.1:
            continue
        share = (now - begin) / (end - begin)
        for k, value in enumerate(values):
            a, b = truth[at][k + 1], truth[at + 1][k + 1]
            sums[k] += (value - (a + share * (b - a))) ** 2
        count += 1
    assert count
    return count, [sqrt(total / count) for total in sums]


def like_closed_form(flight, rounding, least_rows, begin_s=0.0, rounded=None):
    """A flight of the dataset, which began at that time of its log, has the closed form's attitude, rates and commands,
    but for what its log has rounded (of commands another number). Heading counts from anywhere."""
    rows = [[row[0] - begin_s, *row[1:]] for row in numbers(flight, "roll", "pitch", "w_x", "w_y", "w_z", "yaw")]
    truth = [[n / 100, *angles(n / 100)[:2], *rates(n / 100)] for n in range(2400)]
    count, found = errors(truth, [row[:6] for row in rows])
    assert count >= least_rows and max(found) < rounding, found
    u = [[row[0] - begin_s, *row[1:]] for row in numbers(flight, "u1", "u2", "u3", "u4")]
    found = errors([[n / 100, *commands_at(n / 100)] for n in range(2400)], u, LAG_S)[1]
    assert max(found) < (rounded or rounding), found
    for time, *_, yaw in rows:
        turned, expected = yaw - rows[0][-1], angles(time)[2] - angles(rows[0][0])[2]
        assert abs(sin(turned - expected)) < 2 * rounding, time


# files


ULOG_CODES = {"uint64_t": "Q", "uint32_t": "I", "float": "f", "double": "d", "int8_t": "b", "uint8_t": "B"}


def ulog(path, topics, parameters=()):
    """A ULog file. topics: name, fields as its format has them, rows of their numbers, in the order of a logger that
    writes all topics side by side; parameters: name, integer."""
    def message(kind, content):
        return struct.pack("<Hc", len(content), kind) + content

    log, rows = b"ULog\x01\x12\x35\x01" + bytes(8) + message(b"B", bytes(40)), []
    for name, fields, _ in topics:
        log += message(b"F", f"{name}:{';'.join(fields)};".encode())
    for name, value in parameters:
        key = f"int32_t {name}".encode()
        log += message(b"P", bytes([len(key)]) + key + struct.pack("<i", value))
    for number, (name, fields, values) in enumerate(topics):
        log += message(b"A", struct.pack("<BH", 0, number) + name.encode())
        kinds = (re.match(r"(\w+)(?:\[(\d+)\])? ", field).groups() for field in fields)
        code = "".join(ULOG_CODES[kind] * int(count or 1) for kind, count in kinds)
        rows += [(place / len(values), struct.pack(f"<H{code}", number, *(
            float(cell) if letter in "fd" else int(cell) for letter, cell in zip(code, cells))))
            for place, cells in enumerate(values)]
    Path(path).write_bytes(log + b"".join(message(b"D", row) for _, row in sorted(rows, key=lambda row: row[0])))


def usd_log(path, leave_out="nothing"):
    """A Crazyflie's log of the variables that docs/how_to_log.md names."""
    document = (SOURCE / "docs/how_to_log.md").read_text()
    names = re.search(r"on:fixedFrequency\n.*\n.*\n((?:\w+\.\w+\n)+)", document).group(1).split()
    names = [name for name in names if not name.startswith(leave_out)]
    kinds = {name: "I" if name.startswith("motor.") else "f" for name in names}
    head = b"\xbc" + struct.pack("<HHH", 2, 1, 0) + b"fixedFrequency\0" + struct.pack("<H", len(names))
    head += b"".join(f"{name}({kinds[name]})".encode() + b"\0" for name in names)
    rows = b""
    for n in range(2000):
        t = n / 100
        (p, q, r), (fx, fy, fz), (vn, ve, vd), (x, y, z) = rates(t), specific_force(t), velocity(t), position(t)
        u1, u2, u3, u4 = commands_at(t)
        values = dict(zip((f"stateEstimate.q{axis}" for axis in "xyzw"), quaternion_enu_flu(t)))
        values.update(zip(("gyro.x", "gyro.y", "gyro.z"), (degrees(p), -degrees(q), -degrees(r))))
        values.update(zip(("acc.x", "acc.y", "acc.z"), (fx / GRAVITY, -fy / GRAVITY, -fz / GRAVITY)))
        values.update(zip((f"stateEstimate.{name}" for name in ("vx", "vy", "vz", "x", "y", "z")), (ve, vn, -vd, y, x, -z)))
        values.update(zip((f"motor.m{i}" for i in (1, 2, 3, 4)), (round(65535 * u) for u in (u1, u4, u2, u3))))
        values["pm.vbat"] = 4.1 - 0.01 * t
        rows += struct.pack("<HQ" + "".join(kinds.values()), 0, 10000 * n, *(values[name] for name in names))
    Path(path).write_bytes(head + rows + struct.pack("<I", zlib.crc32(head + rows)))


BLACKBOX = ["loopIteration", "time", "vbatLatest", *(f"gyroADC[{i}]" for i in range(3)),
            *(f"accSmooth[{i}]" for i in range(3)), *(f"motor[{i}]" for i in range(4))]


def blackbox_row(t, motors=(158, 2047), acc_1g=2048):
    """As a flight controller logs it: FLU, its own motor order, hundredths of a volt; rates in degrees."""
    (p, q, r), (fx, fy, fz), (u1, u2, u3, u4) = rates(t), specific_force(t), commands_at(t)
    least, most = motors
    return [round(800 * t), round(1e6 * t), 1680 - int(t), degrees(p), -degrees(q), -degrees(r),
            *(round(acc_1g * f / GRAVITY) for f in (fx, -fy, -fz)),
            *(round(least + (most - least) * u) for u in (u4, u1, u2, u3))]


def imu_quaternion(t):
    """x, y, z with w >= 0, FLU to ENU, as a blackbox counts them."""
    *parts, w = quaternion_enu_flu(t)
    return [round(32767 * value * (1 if w >= 0 else -1)) for value in parts]


RATE_HZ, SECONDS, BEGIN_S = 200, 24, 7


def blackbox(firmware="Betaflight 2025.12.1 (abc) STM32H743", attitude="imuQuaternion", attitude_at=imu_quaternion,
             motors=(158, 2047)):
    """A blackbox log: full frames alone, every field a signed number but the count and the time."""
    def number(value):  # zigzag, seven bits a byte
        rest, out = (value << 1) ^ (value >> 63), b""
        while rest > 127:
            out, rest = out + bytes([rest & 127 | 128]), rest >> 7
        return out + bytes([rest])

    names = BLACKBOX + [f"{attitude}[{i}]" for i in range(3)]
    lists = {"name": names, "signed": [0, 0] + [1] * (len(names) - 2), "predictor": [0] * len(names),
             "encoding": [0] * len(names)}
    log = "H Product:Blackbox flight data recorder by Nicholas Sherlock\nH Data version:2\n"
    log += "".join(f"H Field I {key}:{','.join(map(str, values))}\n" for key, values in lists.items())
    log += f"H I interval:1\nH Firmware revision:{firmware}\nH gyro_scale:0x3d800000\nH acc_1G:2048\n"
    log = (log + f"H motorOutput:{motors[0]},{motors[1]}\n").encode()
    for i in range(RATE_HZ * SECONDS):
        t = i / RATE_HZ
        _, _, volts, *row = blackbox_row(t, motors)
        row[:3] = [16 * rate for rate in row[:3]]  # gyro_scale: a sixteenth
        frame = [i, 1e6 * (t + BEGIN_S), volts, *row, *attitude_at(t)]
        log += b"I" + b"".join(number(round(value)) for value in frame)
    return log + b"E\xffEnd of log\0"


def inav():
    def attitude(t):
        roll, pitch, yaw = map(degrees, angles(t))
        return [10 * roll, -10 * pitch, 10 * yaw % 3600]

    return blackbox("INAV 7.1.2 (def) MATEKF765", "attitude", attitude, (1000, 2000))


def dataflash(begin_s=0):
    """A log of ArduPilot's, of the flight from that time on."""
    def message(kind, form, *values):
        return struct.pack("<BBB" + form, 0xa3, 0x95, kind, *values)

    def announced(kind, form, letters, name, names):
        size = 3 + struct.calcsize("<" + form)
        return message(128, "BB4s16s64s", kind, size, name.encode(), letters.encode(), names.encode())

    log = announced(128, "BB4s16s64s", "BBnNZ", "FMT", "Type,Length,Name,Format,Columns")
    log += announced(1, "Q16sf", "QNf", "PARM", "TimeUS,Name,Value")
    log += announced(2, "QBffffff", "QBffffff", "IMU", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ")
    log += announced(3, "Qfff", "Qfff", "ATT", "TimeUS,Roll,Pitch,Yaw")
    log += announced(4, "QHHHHH", "QHHHHH", "RCOU", "TimeUS,C1,C2,C3,C4,C5")
    for name, value in ("MOT_SPIN_MIN", 0.1), ("MOT_SPIN_MAX", 0.9), ("FRAME_CLASS", 1), ("FRAME_TYPE", 1), *(
            (f"SERVO{i + 1}_FUNCTION", 33 + i) for i in range(4)):
        log += message(1, "Q16sf", 0, name.encode(), value)
    for i in range(RATE_HZ * SECONDS):
        t = begin_s + i / RATE_HZ
        time = round(1e6 * (t + BEGIN_S))
        log += message(2, "QBffffff", time, 0, *rates(t), *specific_force(t))
        log += message(3, "Qfff", time, *map(degrees, angles(t)))
        log += message(4, "QHHHHH", time, *(round(1100 + 800 * u) for u in commands_at(t)), 1500)  # an unused servo
    return log
