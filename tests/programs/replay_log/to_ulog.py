# SPDX-License-Identifier: MIT
# A core's log as PX4's logger writes it: the two messages, in the binary format that PX4 publishes.
#   to_ulog.py FOLDER OUT.ulg MESSAGES      MESSAGES: examples/px4_module/msg
import csv
import math
import struct
import sys

folder, target, messages = sys.argv[1:]
letters = {"uint64": "Q", "uint32": "I", "float32": "f", "int8": "b", "uint8": "B"}
ulog_types = {"uint64": "uint64_t", "uint32": "uint32_t", "float32": "float", "int8": "int8_t", "uint8": "uint8_t"}


def message(kind, body):
    return struct.pack("<HB", len(body), ord(kind)) + body


log = b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 0) + message("B", bytes(40))
data = []
for number, (file, topic) in enumerate([("PinnquadRecord", "pinnquad_record"), ("PinnquadSettings", "pinnquad_settings")]):
    fields, code, columns = [], "<", []
    for line in open(f"{messages}/{file}.msg"):
        words = line.split("#")[0].split()
        if len(words) != 2:
            continue
        kind, _, count = words[0].partition("[")
        count = int(count.rstrip("]") or 0)
        fields.append(ulog_types[kind] + (f"[{count}]" if count else "") + " " + words[1])
        for i in range(max(count, 1)):
            code += letters[kind]
            columns.append(f"{words[1]}[{i}]" if count else words[1])
    log += message("F", f"{topic}:{';'.join(fields)};".encode())
    data.append(message("A", struct.pack("<BH", 0, number) + topic.encode()))
    for row in csv.DictReader(open(f"{folder}/flight_{topic}_0.csv")):
        values = [float(row[c]) if letter == "f" else int(row[c]) for c, letter in zip(columns, code[1:])]
        data.append(message("D", struct.pack("<H", number) + struct.pack(code, *values)))
open(target, "wb").write(log + b"".join(data))
