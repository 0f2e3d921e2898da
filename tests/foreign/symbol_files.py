"""The symbol files of `opennck signals`, read back by the tools that they are for: python-snap7, openpyxl as the reader of the workbook, and
awlsim as the compiler of the STEP 7 source. What they find must be what `--format csv` lists, and every tag must be readable."""

import csv
import io
import os
import re
import subprocess

import openpyxl
import snap7
from awlsim.core.main import AwlSim  # First: its modules import each other.
from awlsim.awlcompiler.tokenizer import AwlParser
from awlsim.common.sources import AwlSource, SymTabSource
from awlsim.core.symbolparser import SymTabParser
from checks import PORT, close, equal, holds

MACHINES = [("g1_example", "840d_sl"), ("g1_example", "828d"), ("isg_hard_gantry", "isg")]
BITS = {"X": 1, "B": 8, "W": 16, "D": 32}


def signals(machine, profile, form):
    command = [os.environ["OPENNCK"], "signals", "--machine", machine, "--profile", profile, "--format", form]
    return subprocess.run(command, capture_output=True, check=True, timeout=60)


def listed(machine, profile):
    """Symbol -> data block, first bit, number of bits; a number inside a byte bit by bit."""
    found = {}
    for row in csv.DictReader(io.StringIO(signals(machine, profile, "csv").stdout.decode())):
        block, kind, byte, bit, last = re.match(r"DB(\d+)\.DB([XBWD])(\d+)(?:\.(\d)(?:\.\.(\d))?)?", row["address"]).groups()
        first = int(byte) * 8 + int(bit or 0)
        if last is None:
            found[row["symbol"]] = (int(block), first, BITS[kind])
        else:
            for at in range(int(last) - int(bit) + 1):
                found[f"{row['symbol']}_{at}"] = (int(block), first + at, 1)
    return found


client = snap7.client.Client()
client.connect("127.0.0.1", 0, 2, PORT)

for machine, profile in MACHINES:
    here = f"{machine} {profile}"
    expected = listed(machine, profile)
    holds(f"{here}: signals", len(expected) > 100, f"found {len(expected)}")

    # python-snap7.
    tags = snap7.load_csv(signals(machine, profile, "python-snap7").stdout.decode())
    sizes = {"BOOL": 1, "BYTE": 8, "WORD": 16, "INT": 16, "DWORD": 32, "DINT": 32, "REAL": 32}
    places = {name: (tag.db_number, tag.byte_offset * 8 + tag.bit, sizes[tag.datatype]) for name, tag in tags.items()}
    equal(f"{here}: tags", places, expected)
    if (machine, profile) == MACHINES[0]:
        for name, tag in tags.items():
            found = client.read_tag(tag)
            if tag.datatype == "BOOL":
                byte = client.db_read(tag.db_number, tag.byte_offset, 1)[0]
                equal(f"the value of {name}", found, bool(byte >> tag.bit & 1))
            else:
                holds(f"the value of {name}", found is not None)

    # The workbook of TIA Portal.
    book = openpyxl.load_workbook(io.BytesIO(signals(machine, profile, "tia-xlsx").stdout))
    equal(f"{here}: sheets", book.sheetnames, ["Hmi Tags"])
    head, *rows = book["Hmi Tags"].values
    equal(f"{here}: columns", (len(head), head[0], head[8], head[-1]), (33, "Name", "Address", "Mandatory Commenting"))
    addresses = {}
    for row in rows:
        block, kind, byte, bit = re.match(r"%DB(\d+)\.DB([XBWD])(\d+)(?:\.(\d))?$", row[8]).groups()
        addresses[row[0]] = (int(block), int(byte) * 8 + int(bit or 0), BITS[kind])
    equal(f"{here}: HMI tags", addresses, {name.replace(".", "_"): place for name, place in expected.items()})
    lengths = {place[2]: str((place[2] + 7) // 8) for place in expected.values()}
    holds(f"{here}: lengths", all(row[5] == lengths[addresses[row[0]][2]] for row in rows))

    # STEP 7: table and source, compiled by awlsim.
    table = SymTabParser.parseSource(SymTabSource(name="table", sourceBytes=signals(machine, profile, "step7-asc").stdout))
    source = signals(machine, profile, "step7-awl")
    parser = AwlParser()
    parser.parseSource(AwlSource(name="source", sourceBytes=source.stdout))
    simulator = AwlSim()
    simulator.loadSymbolTable(table)
    simulator.load(parser.getParseTree())
    simulator.build()
    blocks = {number for number, _, _ in expected.values()}
    equal(f"{here}: symbols", len(list(table)), len(blocks))
    text = source.stdout.decode("latin-1")
    full = {}
    for part in re.split(r"^DATA_BLOCK DB ", text, flags=re.M)[1:]:
        shortened = re.findall(r"^   (\w+) : \w+ ;  //([\w.]+): (?:PLC|NCK|HMI): ", part, re.M)
        full[int(part.split()[0])] = dict(shortened)
    compiled = {}
    for number in blocks:
        # Fields without a name are those of arrays.
        for field in simulator.getCPU().getDB(number).struct.fields:
            if field.name and not field.name.startswith("reserved_"):
                place = (number, field.offset.byteOffset * 8 + field.offset.bitOffset, field.bitSize)
                compiled[place] = field.name
    left_out = set(re.findall(r"`([^`]+)` at DB", source.stderr.decode()))
    for name, place in expected.items():
        signal = name.split(".", 1)[1]
        if signal in left_out and place not in compiled:
            continue
        found = compiled.get(place, "none")
        equal(f"{here}: the component of {name}", full[place[0]].get(found, found), signal)
        holds(f"{here}: at most 24 characters", len(found) <= 24, found)
    holds(f"{here}: no other components", set(compiled) <= set(expected.values()))

client.disconnect()
close()
