"""The RIHS01 hash of each type, computed from its definition, against the one that palpate tells: type_hashes.py PROGRAM.

The hash is the SHA-256 of a type's description as JSON (ROS 2's rosidl, from Iron on).
"""

import hashlib
import json
import re
import subprocess
import sys

IDS = {"int8": 2, "uint8": 3, "int16": 4, "uint16": 5, "int32": 6, "uint32": 7, "int64": 8, "uint64": 9,
       "float32": 10, "float64": 11, "bool": 15, "byte": 16, "string": 17}
NESTED, FIXED_ARRAY, SEQUENCE = 1, 48, 144


def full(name):
    return name.replace("/", "/msg/", 1)


def field(line):
    written, name = line.split()
    base, array, size = re.fullmatch(r"([\w/]+)(\[(\d*)\])?", written).groups()
    kind = IDS.get(base, NESTED) + (0 if not array else FIXED_ARRAY if size else SEQUENCE)
    return {"name": name, "type": {"type_id": kind, "capacity": int(size or 0), "string_capacity": 0,
                                   "nested_type_name": "" if base in IDS else full(base)}}


def description(name, lines):
    return {"type_name": name, "fields": [field(line) for line in lines]}


def hash_of(name, schema):
    first, *others = re.split(r"=+\nMSG: (\S+)\n", schema)
    parts = sorted(((full(n), text.split("\n")) for n, text in zip(others[::2], others[1::2])))
    whole = {"type_description": description(name, [line for line in first.split("\n") if line]),
             "referenced_type_descriptions": [description(n, [line for line in lines if line]) for n, lines in parts]}
    return hashlib.sha256(json.dumps(whole).encode()).hexdigest()


def types(program):
    """(name, hash, hex, schema) of each."""
    text = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    for head, body in re.findall(r"^(\S.*)\n((?:  .*\n)*)", text, re.M):
        name, told, encoded = head.split(" ")
        yield name, told, encoded, "\n".join(line[2:] for line in body.split("\n"))


def main():
    wrong = [f"{name}: told {told}, is {found}" for name, told, _, schema in types(sys.argv[1])
             if (found := hash_of(name, schema)) != told]
    print("\n".join(wrong) or "all hashes are right")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
