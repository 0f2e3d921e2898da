#!/usr/bin/env python3
"""Checks the OPC UA server with asyncua, a client of another project.

    python3 tests/foreign/opc_ua.py --opennck PROGRAM [--keep DIRECTORY] [--only NAME]

The program must have the feature `opcua`. asyncua is installed into DIRECTORY; python-snap7 is used to compare values if it is there. The
exit code is 1 if a check failed, 3 if asyncua or the feature is not available.
"""

import argparse
import asyncio
import json
import logging
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
PROJECT = HERE.parent.parent
MACHINE = PROJECT / "machine_data" / "g1_example"
INSTALLING = 240
# The server is asked for every edge: sampling 0, and a queue that does not overflow.
EVERY_EDGE = {"sampling_interval": 0, "queuesize": 10000}


class Absent(Exception):
    """Something is not available here; the text is the reason."""


def asyncua(keep):
    folder = keep / "opc-ua"
    if not (folder / "asyncua").exists():
        pip = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--target", str(folder)]
        try:
            done = subprocess.run([*pip, "-r", str(HERE / "requirements-opc-ua.txt")], capture_output=True, text=True, timeout=INSTALLING)
        except (FileNotFoundError, subprocess.TimeoutExpired) as error:
            raise Absent(str(error)[:120]) from None
        if not (folder / "asyncua").exists():
            raise Absent(((done.stderr or done.stdout).strip().splitlines() or ["pip failed"])[-1][:120])
    sys.path.insert(0, str(folder))


class Server:
    """`opennck serve` with OPC UA."""

    def __init__(self, program, *arguments, address="127.0.0.1", variables=None):
        command = [program, "serve", *arguments, "--s7", "127.0.0.1:0", "--opcua", f"{address}:0"]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=variables)
        self.url = self.s7 = None
        for line in self.process.stdout:
            found = re.search(r"OPC UA on opc\.tcp://[0-9.]+:(\d+)", line)
            self.url = f"opc.tcp://127.0.0.1:{found[1]}" if found else self.url
            found = re.search(r"S7 on 127\.0\.0\.1:(\d+)", line)
            self.s7 = int(found[1]) if found else self.s7
            if "Ctrl-C" in line:
                return
        error = self.process.stderr.read()
        if "--opcua" in error and "unexpected argument" in error:
            raise Absent("the program was built without the feature opcua")
        raise SystemExit(f"{program} serve ended before it printed its address: {error}")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGTERM)
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            holds("the server ends", False, "it was still running 10 s after SIGTERM")


done, failed = 0, []


def holds(what, is_true, why=""):
    global done
    done += 1
    if not is_true:
        failed.append(what)
        print(f"FAILED {what}: {why}", flush=True)


def equal(what, found, expected):
    holds(what, found == expected, f"expected {expected!r}, found {found!r}")


async def refused(what, action, name):
    """Checks that a call fails with this status."""
    from asyncua import ua
    try:
        found = await action
    except ua.UaStatusCodeError as error:
        return equal(what, ua.status_codes.get_name_and_doc(error.code)[0], name)
    holds(what, False, f"expected {name}, found {found!r}")


class Values:
    """Takes the values of a subscription."""

    def __init__(self):
        self.found = {}

    def datachange_notification(self, node, value, data):
        stamp = data.monitored_item.Value.SourceTimestamp
        self.found.setdefault(node.nodeid.Identifier, []).append((value, stamp))


def node(client, text):
    return client.get_node(f"ns=2;s={text}")


async def ids(program):
    """Node ids, types, browsing, statuses."""
    from asyncua import Client, ua
    with Server(program, str(MACHINE)) as server:
        async with Client(server.url) as client:
            spaces = await client.get_namespace_array()
            equal("the namespace has index 2", spaces.index("SinumerikVarProvider"), 2)
            kind = ua.VariantType
            for text, expected in [
                ("/Plc/M5.0", kind.Boolean), ("/Plc/MB5", kind.UInt32), ("/Plc/MW6", kind.UInt32), ("/Plc/MD8", kind.UInt32),
                ("/Plc/MW6:INT", kind.Int32), ("/Plc/MD8:DINT", kind.Int32), ("/Plc/MD8:REAL", kind.Double),
                ("/Plc/DB31.DBX60.4", kind.Boolean), ("/Plc/T5", kind.UInt32), ("/Plc/C5", kind.Byte),
                ("/Plc/MB5:CHAR", kind.String), ("/Channel/State/chanStatus", kind.UInt32), ("/Bag/State/opMode", kind.UInt32),
                ("/Channel/MachineAxis/actToolBasePos[u1,1]", kind.Double), ("/Channel/MachineAxis/name[u1, 2]", kind.String),
                ("/Nck/State/numAlarms", kind.UInt32), ("/OpenNCK/Cycle", kind.UInt64),
                ("/NC/_N_CH_TEA_ACX/$MC_CHAN_NAME[u1]", kind.String), ("/NC/_N_AX_TEA_ACX/$MA_GANTRY_AXIS_TYPE[u1]", kind.UInt32),
            ]:
                value = await node(client, text).read_data_value(raise_on_bad_status=False)
                equal(f"the type of {text}", value.Value and value.Value.VariantType, expected)
            for text, length in [("/Plc/MB0:[10]", 10), ("/Plc/MD0:REAL[4]", 4), ("/Channel/MachineAxis/actToolBasePos[u1,1,#2]", 2)]:
                equal(f"the length of {text}", len(await node(client, text).read_value()), length)
            for text, status in [
                ("/Plc/nonsense", "BadNodeIdUnknown"), ("/Channel/State/nonsense", "BadNodeIdUnknown"), ("/plc/MB5", "BadNodeIdUnknown"),
                ("/Plc/DB999.DBB0", "BadAttributeIdInvalid"), ("/Plc/MB", "BadAttributeIdInvalid"),
                ("/Channel/MachineAxis/actToolBasePos[u1,31]", "BadAttributeIdInvalid"), ("/Channel/State/chanStatus[u9]", "BadAttributeIdInvalid"),
                ("/Nck/MachineAxis/vaPower[u1,1]", "BadAttributeIdInvalid"),
            ]:
                await refused(f"reading {text}", node(client, text).read_value(), status)
            # Browsing: the root, one axis, and all attributes of a signal.
            names = [(await child.read_browse_name()).Name for child in await client.nodes.objects.get_children()]
            holds("the root is under Objects", "Sinumerik" in names, names)
            root = await client.nodes.objects.get_child(["2:Sinumerik"])
            top = [(await child.read_browse_name()).Name for child in await root.get_children()]
            equal("the folders", top, ["Plc", "Channel", "Nck", "Bag", "TEA", "OpenNCK"])
            axes = await root.get_child(["2:Channel", "2:MachineAxis"])
            children = [child.nodeid.Identifier for child in await axes.get_children()]
            holds("all axes are shown", {"/Channel/MachineAxis/actToolBasePos", "/Channel/MachineAxis/actToolBasePos[u1,2]"} <= set(children), children[:5])
            referenced = await root.get_child(["2:Plc", "2:DB31", "2:DB31.DBX60.4"])
            holds("a signal is described", "referenced" in (await referenced.read_description()).Text)
            equal("its parent", (await referenced.get_parent()).nodeid.Identifier, "/Plc/DB31")
            equal("an axis of OPC 40502", await node(client, "CncInterface/CncAxisList/X/IsReferenced").read_value(), False)
            await refused("a value that the simulator does not have", node(client, "CncInterface/CncAxisList/X/ActLoad").read_value(), "BadNotSupported")
            many = [node(client, f"/Plc/MB{byte}") for byte in range(200)] * 10
            equal("2,000 nodes in a request", len(await client.read_values(many)), 2000)


async def edges(program, speed):
    """Every edge of a bit that changes in each cycle, and every value of a counter."""
    from asyncua import Client
    cycle = 0.002
    seconds = 5 if speed <= 1 else 2
    with tempfile.TemporaryDirectory() as folder:
        with Server(program, str(MACHINE), "--plc", str(HERE / "opc_ua"), "--speed", str(speed)) as server:
            async with Client(server.url) as client:
                values = Values()
                subscription = await client.create_subscription(50, values)
                watched = [node(client, text) for text in ("/Plc/M10.0", "/Plc/MW12", "/OpenNCK/Cycle")]
                await subscription.subscribe_data_change(watched, **EVERY_EDGE)
                before = time.time()
                await asyncio.sleep(seconds)
                await subscription.delete()
                after = time.time()
        del folder
    bit, count, cycles = (values.found.get(text, []) for text in ("/Plc/M10.0", "/Plc/MW12", "/OpenNCK/Cycle"))
    expected = seconds * speed / cycle
    # A busy computer does not reach ten times real time; what the machine did must arrive all the same.
    holds(f"speed {speed}: edges arrive", len(bit) > (0.8 if speed <= 1 else 0.02) * expected, f"expected about {expected}, found {len(bit)}")
    passed = cycles[-1][0] - cycles[0][0] if cycles else 0
    holds(f"speed {speed}: an edge in each cycle", abs(len(bit) - 1 - passed) <= 1, f"{passed} cycles, {len(bit)} values")
    holds(f"speed {speed}: the bit changes with every value", all(a[0] != b[0] for a, b in zip(bit, bit[1:])))
    gaps = [(a[0], b[0]) for a, b in zip(count, count[1:]) if b[0] != (a[0] + 1) % 65536]
    equal(f"speed {speed}: no value of the counter is missing", gaps, [])
    gaps = [(a[0], b[0]) for a, b in zip(cycles, cycles[1:]) if b[0] != a[0] + 1]
    equal(f"speed {speed}: no cycle is missing", gaps, [])
    stamps = [stamp.timestamp() for _, stamp in count[1:]]
    holds(f"speed {speed}: time does not go back", all(a <= b for a, b in zip(stamps, stamps[1:])))
    holds(f"speed {speed}: no instant is in the future", all(before - 1 < stamp <= after for stamp in stamps))
    if speed == 1 and len(stamps) > 2:
        # As long as the schedule is kept, the instants are exactly one cycle apart.
        regular = sum(abs(b - a - cycle) < 1e-5 for a, b in zip(stamps, stamps[1:]))
        holds("speed 1: instants are one cycle apart", regular > 0.95 * (len(stamps) - 1), f"{regular} of {len(stamps) - 1}")


async def writes(program):
    """Writes, conversions, rights."""
    from asyncua import Client, ua
    with Server(program, str(MACHINE)) as server:
        async with Client(server.url) as client:
            async def put(text, value, kind):
                await node(client, text).write_value(ua.DataValue(ua.Variant(value, kind)))
                return await node(client, text).read_value()
            kind = ua.VariantType
            equal("a bit", await put("/Plc/M20.3", True, kind.Boolean), True)
            equal("a byte as UInt16", await put("/Plc/MB21", 200, kind.UInt16), 200)
            equal("a word as Int64", await put("/Plc/MW22", 65535, kind.Int64), 65535)
            equal("a word as 1.0", await put("/Plc/MW22", 1.0, kind.Double), 1)
            equal("a signed word", await put("/Plc/MW24:INT", -5, kind.Int16), -5)
            equal("a REAL", await put("/Plc/MD26:REAL", 1.5, kind.Float), 1.5)
            equal("an array", await put("/Plc/MB30:[3]", [1, 2, 3], kind.UInt32), [1, 2, 3])
            await put("/Plc/MB40", 10, kind.Byte)
            equal("a text", await put("/Plc/MB40:STRING", "Hallo", kind.String), "Hallo")
            equal("its length", await node(client, "/Plc/MB41").read_value(), 5)
            equal("an R parameter", await put("/Channel/Parameter/R[u1,5]", 2.25, kind.Double), 2.25)
            equal("R0", await put("/Channel/Parameter/R[0]", 3, kind.Int32), 3.0)
            equal("R1 to R3", await put("/Channel/Parameter/R[u1,1,3]", [1.0, 2.0, 3.0], kind.Double), [1.0, 2.0, 3.0])
            equal("a signal of the PLC", await put("/Plc/DB31.DBX2.1", 1, kind.Byte), True)
            for text, value, of, status in [
                ("/Plc/MB21", 256, kind.UInt32, "BadOutOfRange"), ("/Plc/MB21", "x", kind.String, "BadTypeMismatch"),
                ("/Plc/MB40:STRING", "longer than ten", kind.String, "BadOutOfRange"), ("/Plc/T5", 1, kind.UInt32, "BadNotWritable"),
                ("/Plc/MB30:[3]", [1, 2], kind.UInt32, "BadOutOfRange"), ("/Plc/DB999.DBB0", 1, kind.Byte, "BadAttributeIdInvalid"),
                ("/Channel/State/chanStatus", 1, kind.UInt32, "BadNotWritable"), ("/OpenNCK/Cycle", 1, kind.UInt64, "BadNotWritable"),
                ("/Plc/nonsense", 1, kind.Byte, "BadNodeIdUnknown"),
            ]:
                await refused(f"writing {value!r} to {text}", put(text, value, of), status)
    with Server(program, str(MACHINE), "--protect", "MB20..21") as server:
        async with Client(server.url) as client:
            one = ua.DataValue(ua.Variant(1, ua.VariantType.Byte))
            await refused("writing a protected byte", node(client, "/Plc/MB21").write_value(one), "BadUserAccessDenied")
            await node(client, "/Plc/MB22").write_value(one)
    with Server(program, str(MACHINE), "--read-only") as server:
        async with Client(server.url) as client:
            await refused("writing with --read-only", node(client, "/Plc/MB22").write_value(one), "BadUserAccessDenied")


async def same_as_s7(program):
    """OPC UA and S7 communication read the same values."""
    from asyncua import Client
    pairs = [
        ("/Plc/DB10.DBB108", "DB10.DBB108"), ("/Plc/DB31.DBD60", "DB31.DBD60"), ("/Plc/DB21.DBW35", "DB21.DBW35"),
        ("/Channel/MachineAxis/actToolBasePos[u1,2]", "nck:C/MachineAxis/actToolBasePos[2]"),
        ("/Channel/MachineAxis/name[u1,2]", "nck:C/MachineAxis/name[2]"), ("/Channel/MachineAxis/feedRateOvr[u1,1]", "nck:C/MachineAxisExt/feedRateOvr[1]"),
        ("/Channel/State/chanStatus", "nck:C/State/chanStatus"), ("/Channel/State/progStatus", "nck:C/State/progStatus"),
        ("/Bag/State/opMode", "nck:B/State/opMode"), ("/Nck/State/numAlarms", "nck:N/State/numAlarms"),
        ("/Nck/LastAlarm/textIndex", "nck:N/LastAlarm/textIndex"), ("/Channel/Parameter/R[u1,5]", "nck:C/Parameter/rpa[6]"),
        ("/NC/_N_NC_TEA_ACX/$MN_HW_SERIAL_NUMBER", "nck:N/$MN_HW_SERIAL_NUMBER"),
        ("/NC/_N_CH_TEA_ACX/$MC_CHAN_NAME[u1]", "nck:C/$MC_CHAN_NAME"),
    ]
    with Server(program, str(MACHINE)) as server:
        async with Client(server.url) as client:
            await node(client, "/Channel/Parameter/R[u1,5]").write_value(1.25)
            await asyncio.sleep(0.5)
            for text, address in pairs:
                value = await node(client, text).read_value()
                read = subprocess.run([program, "s7", "read", f"127.0.0.1:{server.s7}", address, "--format", "json"], capture_output=True, text=True)
                if read.returncode:
                    holds(f"{text} is {address}", False, read.stderr)
                    continue
                other = json.loads(read.stdout)
                other = other[0] if isinstance(other, list) else other
                holds(f"{text} is {address}", other.get("value") == value, f"OPC UA {value!r}, S7 {other}")


def alarm_filter(ua):
    event_filter = ua.EventFilter()
    names = ["EventType", "SourceName", "Severity", "Message", "Retain", "ConditionName"]
    paths = [(ua.NodeId(ua.ObjectIds.ConditionType), [ua.QualifiedName(name, 0)]) for name in names]
    paths.append((ua.NodeId(ua.ObjectIds.AlarmConditionType), [ua.QualifiedName("ActiveState", 0), ua.QualifiedName("Id", 0)]))
    # A field that no event has is null, and those after it keep their places.
    paths.append((ua.NodeId(ua.ObjectIds.AlarmConditionType), [ua.QualifiedName("MaxTimeShelved", 0)]))
    paths += [(ua.NodeId(1006, 3), [ua.QualifiedName(name, 3)]) for name in ("AlarmIdentifier", "AuxParameters", "HelpSource")]
    for kind, path in paths:
        clause = ua.SimpleAttributeOperand(TypeDefinitionId=kind, BrowsePath=path, AttributeId=ua.AttributeIds.Value)
        event_filter.SelectClauses.append(clause)
    # The ConditionId.
    clause = ua.SimpleAttributeOperand(TypeDefinitionId=ua.NodeId(ua.ObjectIds.ConditionType), BrowsePath=[], AttributeId=ua.AttributeIds.NodeId)
    event_filter.SelectClauses.append(clause)
    return event_filter


class Raw:
    """Takes events as lists of fields, in the order of the filter."""

    def __init__(self):
        self.found = []

    def event_notification(self, event):
        self.found.append(event)


async def subscribed(client, ua):
    """A client with a subscription to alarms."""
    events = Raw()
    subscription = await client.create_subscription(20, events)
    await subscription.subscribe_events(client.nodes.server, evfilter=alarm_filter(ua), queuesize=100)
    return events, subscription


async def refresh(client, subscription, ua):
    condition = client.get_node(ua.ObjectIds.ConditionType)
    method = ua.NodeId(ua.ObjectIds.ConditionType_ConditionRefresh)
    await condition.call_method(method, ua.Variant(subscription.subscription_id, ua.VariantType.UInt32))


def about(events, number):
    return [event for event in events.found if getattr(event, "AlarmIdentifier", None) == number]


async def alarms(program):
    """Two alarms of the same cycle, a client that comes late, and what an alarm has."""
    from asyncua import Client, ua
    with Server(program, str(MACHINE)) as server:
        async with Client(server.url) as client:
            events, subscription = await subscribed(client, ua)
            # There is no seventh parameter set: 25200 on both axes.
            both = [node(client, "/Plc/DB31.DBB9"), node(client, "/Plc/DB32.DBB9")]
            six = ua.DataValue(ua.Variant(6, ua.VariantType.Byte))
            await client.write_values(both, [six, six])
            await asyncio.sleep(0.5)
            found = about(events, "25200")
            equal("two alarms of the same cycle arrive", len(found), 2)
            holds("each names its axis", len({tuple(event.AuxParameters) for event in found}) == 2, [event.AuxParameters for event in found])
            if found:
                event = found[0]
                equal("the type", event.EventType, ua.NodeId(1006, 3))
                equal("the source", event.SourceName, "NCK")
                equal("an alarm with a reaction", event.Severity, 1000)
                equal("it is pending", event.Retain, True)
                holds("the text", "parameter set invalid" in event.Message.Text, event.Message)
                holds("the cause", "controller_parameter_set = 6" in event.HelpSource.Text, event.HelpSource)
            # A late client gets what is pending by ConditionRefresh.
            async with Client(server.url) as late:
                others, second = await subscribed(late, ua)
                await asyncio.sleep(0.3)
                equal("a late client gets nothing by itself", len(about(others, "25200")), 0)
                await refresh(late, second, ua)
                await asyncio.sleep(0.3)
                equal("a late client gets what is pending", len(about(others, "25200")), 2)
                kinds = [event.EventType for event in others.found]
                marks = [ua.NodeId(ua.ObjectIds.RefreshStartEventType), ua.NodeId(ua.ObjectIds.RefreshEndEventType)]
                equal("between start and end", [kinds[0], kinds[-1]] if kinds else [], marks)
                await refused("a refresh of no subscription", late.get_node(ua.ObjectIds.ConditionType).call_method(
                    ua.NodeId(ua.ObjectIds.ConditionType_ConditionRefresh), ua.Variant(99999, ua.VariantType.UInt32)), "BadSubscriptionIdInvalid")
            # RESET clears both.
            events.found.clear()
            zero = ua.DataValue(ua.Variant(0, ua.VariantType.Byte))
            await client.write_values(both, [zero, zero])
            reset = node(client, "/Plc/DB21.DBX7.7")
            await reset.write_value(ua.DataValue(ua.Variant(True, ua.VariantType.Boolean)))
            await asyncio.sleep(0.5)
            gone = [event for event in about(events, "25200") if not event.Retain]
            equal("both are gone after RESET", len(gone), 2)


async def security(program):
    """Users, encryption, and what is refused."""
    from asyncua import Client, ua
    from asyncua.crypto.cert_gen import setup_self_signed_certificate
    from asyncua.crypto.security_policies import SecurityPolicyBasic256Sha256
    from cryptography.x509.oid import ExtendedKeyUsageOID
    variables = {**os.environ, "OPENNCK_OPCUA_PASSWORD_panel": "secret"}
    with Server(program, str(MACHINE), "--opcua-user", "panel:StateRead;PlcRead", variables=variables) as server:
        anonymous = Client(server.url)
        await refused("a client without a user", anonymous.connect(), "BadIdentityTokenInvalid")
        wrong = Client(server.url)
        wrong.set_user("panel")
        wrong.set_password("guess")
        await refused("a wrong password", wrong.connect(), "BadUserAccessDenied")
        client = Client(server.url)
        client.set_user("panel")
        client.set_password("secret")
        async with client:
            equal("a user reads", await node(client, "/Plc/MB5").read_value(), 0)
            one = ua.DataValue(ua.Variant(1, ua.VariantType.Byte))
            await refused("a user without PlcWrite writes", node(client, "/Plc/MB5").write_value(one), "BadUserAccessDenied")
            datum = node(client, "/NC/_N_AX_TEA_ACX/$MA_GANTRY_AXIS_TYPE[u1]")
            await refused("a user without TeaRead reads", datum.read_value(), "BadUserAccessDenied")
    refusal = subprocess.run([program, "serve", str(MACHINE), "--s7", "127.0.0.1:0", "--opcua", "0.0.0.0:0"], capture_output=True, text=True, timeout=20)
    holds("beyond loopback without encryption", refusal.returncode == 2 and "without encryption" in refusal.stderr, refusal.stderr)
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        key, certificate = folder / "client.pem", folder / "client.der"
        await setup_self_signed_certificate(key, certificate, "urn:test:client", "client", [ExtendedKeyUsageOID.CLIENT_AUTH], {})
        pki = folder / "pki"
        with Server(program, str(MACHINE), "--opcua-pki", str(pki), address="0.0.0.0") as server:
            equal("only its owner reads the key", (pki / "private" / "private.pem").stat().st_mode & 0o777, 0o600)
            async def connected():
                client = Client(server.url)
                client.application_uri = "urn:test:client"
                await client.set_security(SecurityPolicyBasic256Sha256, str(certificate), str(key), server_certificate=str(pki / "own" / "cert.der"))
                async with client:
                    return await node(client, "/OpenNCK/Speed").read_value()
            plain = Client(server.url)
            try:
                await plain.connect()
                holds("a client without encryption beyond loopback", False, "it was admitted")
            except Exception:
                holds("a client without encryption beyond loopback", True)
            try:
                await connected()
                holds("a client with an unknown certificate", False, "it was admitted")
            except Exception:
                holds("a client with an unknown certificate", True)
            rejected = list((pki / "rejected").iterdir())
            equal("its certificate is kept", len(rejected), 1)
            for file in rejected:
                file.rename(pki / "trusted" / file.name)
            equal("a client whose certificate is trusted", await connected(), 1.0)


CHECKS = {
    "ids": ids,
    "edges": lambda program: edges(program, 1),
    "slow": lambda program: edges(program, 0.1),
    "fast": lambda program: edges(program, 10),
    "writes": writes,
    "s7": same_as_s7,
    "alarms": alarms,
    "security": security,
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--opennck", required=True, help="the program")
    parser.add_argument("--keep", type=Path, default=Path(tempfile.gettempdir()) / "opennck-opc-ua", help="folder for asyncua")
    parser.add_argument("--only", choices=CHECKS, help="one group of checks")
    arguments = parser.parse_args()
    arguments.keep.mkdir(parents=True, exist_ok=True)
    logging.disable(logging.CRITICAL)
    try:
        asyncua(arguments.keep.resolve())
        for name, check in CHECKS.items():
            if arguments.only in (None, name):
                before = len(failed)
                asyncio.run(check(arguments.opennck))
                print(f"{name}: {'FAILED' if len(failed) > before else 'passed'}", flush=True)
    except Absent as absent:
        print(f"asyncua  absent: {absent}")
        sys.exit(3)
    print(f"checks {done} failed {len(failed)}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
