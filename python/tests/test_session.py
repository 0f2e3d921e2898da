"""A session: every verb of scenarios, values, traces, errors, saved states, functions as PLC programs."""

import json
import math
import re
import threading

import opennck
import pytest


@pytest.fixture
def machine():
    return opennck.Session("g1_example", plc="enable_all")


def moving(machine):
    machine.wait("X.position_controller_active", within="1s")
    machine.set("X.traversing_key_plus", 1)
    machine.wait("X.position > 5", within="2s")


def test_a_pressed_key_moves_the_axis(machine):
    machine.watch("X.traverse_command_*", "X.position")
    moving(machine)
    assert machine.get("X.position") > 5
    assert machine.values("X.traverse_command_plus", "alarms()") == {"X.traverse_command_plus": 1.0, "alarms()": 0.0}
    rows = machine.trace.rows()
    edge = next(row for row in rows if row.get("symbol") == "X.traverse_command_plus")
    assert edge["signal"] == "DB31.DBX64.7" and edge["value"] == 1 and edge["by"] == "nck"
    assert "DB31.DBX64.7" in machine.trace.text()
    assert "because" not in machine.trace.text(causes=False)
    assert machine.trace.svg().startswith("<svg") and machine._repr_svg_() == machine.trace._repr_svg_()
    assert machine.trace.vcd().startswith("$")
    assert [json.loads(line) for line in machine.trace.json_lines().splitlines()] == rows


def test_every_verb_of_scenarios_is_a_method(machine):
    with pytest.raises(opennck.Error) as raised:
        machine.step({"no_such_verb": 1})
    with pytest.raises(opennck.Error) as listed:
        machine.step({})
    verbs = re.search(r"verbs are (.*)", str(listed.value)).group(1).split(", ")
    assert len(verbs) == 28, raised.value
    for verb in verbs:
        assert callable(getattr(machine, verb)), verb


def test_the_verbs_act(machine):
    machine.set({"X.traversing_key_plus": 1, "X.feed_override": "50%"})
    machine.write("DB31.DBB4", 0)
    machine.force("M10.0", True)
    machine.run("10ms")
    machine.expect("M10.0 == 1", "X.traversing_key_plus == 0")
    machine.image({"MB10": "2#0000_0001"})
    machine.release("M10.0")
    machine.set("M10.0", 0)
    machine.pulse("M10.1", length="20ms")
    machine.hold("M10.0 == 0", during="20ms")
    assert machine.capture("before", "X.position") == machine.get("before")
    machine.machine_data("37110[X]", 0.5)
    machine.r_parameters("R5", 2.5)
    machine.new_conf()
    machine.handwheel(1, 10, "100ms")
    machine.mdi("G0 X1")
    machine.plc("stop")
    machine.run("10ms")
    assert machine.get("R5") == 2.5
    machine.plc("run")
    machine.cancel()
    machine.fault("X", "drive_fault")
    machine.wait("alarms() > 0", within="1s")
    assert machine.alarms
    machine.clear_fault("X", "drive_fault")
    machine.power_on()
    machine.run("1s")
    machine.preset("Y", 5.0)
    machine.nc("N10 G0 X1\nM30\n")
    machine.search("N10", "contour")
    machine.function_generator("X", amplitude=0.1, frequency=10.0, duration="1s")
    machine.run("10ms")
    machine.note("the end")
    machine.run("10ms")
    assert [row["note"] for row in machine.trace if "note" in row] == ["the end"]
    assert machine.axes == ["X", "Y", "XF"] and machine.channels == ["CHAN1"]
    assert math.isclose(machine.time, machine.cycle * 0.002)


def test_lists_of_the_isg_kernel_are_updated():
    machine = opennck.Session("isg_hard_gantry")
    machine.list("ax6:kenngr.gantry_ax_nr", 2)
    machine.run("10ms")


def test_steps_of_a_file_are_included(machine, tmp_path):
    (tmp_path / "part.toml").write_text('[[step]]\nset = { "M20.0" = 1 }\n[[step]]\nrun = "2ms"\n')
    machine.include(tmp_path / "part.toml", times=2)
    assert machine.get("M20.0") == 1
    (tmp_path / "part.mpf").write_text("N10 G0 X1\nM30\n")
    machine.program(tmp_path / "part.mpf")
    machine.run("10ms")


def test_what_is_wrong_is_said_as_the_program_says_it(machine):
    with pytest.raises(opennck.Error) as raised:
        machine.set("X.traversing_kee_plus", 1)
    assert str(raised.value) == (
        "expected a signal of `X` (axis 1), found `X.traversing_kee_plus`\n  did you mean `X.traversing_key_plus`?"
    )
    with pytest.raises(opennck.Missed, match="X.position = 0") as missed:
        machine.wait("X.position > 5", within="10ms")
    assert "no alarm is pending" in str(missed.value)
    assert issubclass(opennck.Missed, opennck.Error)
    with pytest.raises(opennck.Error, match="g1_example"):
        opennck.Session("no_such_machine")
    with pytest.raises(opennck.Error, match="enable_all"):
        opennck.Session("g1_example", plc="enable_al")
    with pytest.raises(opennck.Error, match="a function"):
        opennck.Session("g1_example", plc=3)
    with pytest.raises(TypeError):
        machine.set("X.traversing_key_plus")


def test_rules_hold_in_every_cycle(machine):
    machine.never("X.position > 3")
    with pytest.raises(opennck.Missed, match="X.position > 3"):
        moving(machine)
    machine = opennck.Session("g1_example", plc="enable_all")
    machine.always("alarms() == 0")
    machine.follows("the command follows", "X.traversing_key_plus", "X.traverse_command_plus", "100ms")
    moving(machine)


def test_a_saved_machine_continues_with_the_same_bytes(machine):
    moving(machine)
    saved = machine.save()
    fork = machine.fork()
    machine.run("100ms")
    fork.run("100ms")
    end = machine.save()
    assert fork.save() == end and fork.trace.text() == machine.trace.text()
    other = opennck.Session("g1_example", plc="enable_all")
    other.restore(saved)
    assert other.time == 0 and other.trace.rows() == []
    other.run("100ms")
    assert other.save() == end
    with pytest.raises(opennck.Error, match="too few bytes"):
        other.restore(b"")


def test_a_function_is_a_plc_program():
    seen = []

    def plc(io):
        if io.first_scan:
            io.state["scans"] = 0
            seen.append(io.axes)
        io.state["scans"] += 1
        on = io["I0.0"]
        for axis in io.axes:
            io[f"{axis}.position_measuring_system_1"] = True
            io[f"{axis}.controller_enable"] = on
            io[f"{axis}.pulse_enable"] = on
        io["MW10"] = io.state["scans"]
        io["QB0"] = "16#0F"
        io["MD20:REAL"] = 1.5
        assert io["MD20:REAL"] == 1.5 and io["QB0"] == 15 and io.cycle_time > 0

    machine = opennck.Session("g1_example", plc=plc)
    machine.set("X.traversing_key_plus", 1)
    machine.hold("X.position == 0", "500ms")
    machine.set("I0.0", 1)
    machine.wait("X.position > 1", "2s")
    assert seen == [["X", "Y", "XF"]]
    assert machine.get("MW10") == machine.cycle
    rows = [row for row in machine.trace if row.get("symbol") == "X.controller_enable"]
    assert [(row["value"], row["by"]) for row in rows] == [(1, "plc")]
    fork = machine.fork()
    saved = machine.save()
    machine.run("100ms")
    fork.run("100ms")
    assert fork.save() == machine.save()
    scans = machine.get("MW10")
    machine.restore(saved)
    machine.run("100ms")
    assert machine.get("MW10") == scans
    machine.power_on()
    machine.run("20ms")
    assert machine.get("MW10") <= 10


def test_what_a_function_raises_comes_to_its_caller():
    def plc(io):
        if io.time > 0.1:
            raise ValueError("the valve is missing")

    machine = opennck.Session("g1_example", plc=plc)
    with pytest.raises(ValueError, match="the valve is missing"):
        machine.run("1s")
    assert machine.get("alarm(2000)") == 1, "the PLC has stopped"
    for name, value, said in [
        ("X.referenced_synchronized_1", 1, "the NCK writes"),
        ("I0.0", 1, "the PLC writes"),
        ("X.no_signal", 1, "X.no_signal"),
        ("MB0", 1000, "from -128 to 255"),
    ]:
        machine = opennck.Session("g1_example", plc=lambda io, name=name, value=value: io.__setitem__(name, value))
        with pytest.raises(opennck.Error, match=re.escape(said)):
            machine.run("10ms")
    machine = opennck.Session("g1_example", plc=lambda io: io.state.update(what=object()))
    machine.run("10ms")
    for act in (machine.fork, machine.save):
        with pytest.raises(opennck.Error, match="io.state"):
            act()


def test_a_session_is_used_by_one_call_at_a_time():
    def plc(io):
        with pytest.raises(opennck.Error, match="in use"):
            machine.get("M0.0")

    machine = opennck.Session("g1_example", plc=plc)
    machine.run("10ms")
    threads = [threading.Thread(target=opennck.Session("g1_example").run, args=("1s",)) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def test_a_profile_and_an_image(tmp_path):
    (tmp_path / "image.toml").write_text('[[db]]\nnumber = 1000\nsize = 8\nvalues = { "DBW2" = 250 }\n')
    machine = opennck.Session("g1_example", profile="828d", plc_image=tmp_path / "image.toml", watch=["X.position"])
    assert machine.get("DB1000.DBW2") == 250
    machine.set("DB3800.DBX4.7", 1)
    machine.run("10ms")


def test_the_trace_is_a_table(machine):
    machine.watch("X.traverse_command_plus", "X.position")
    moving(machine)
    machine.note("a note")
    machine.run("10ms")
    columns = machine.trace.columns()
    assert len({len(column) for column in columns.values()}) == 1
    kinds = dict(zip(columns["name"], columns["kind"]))
    assert kinds["X.traverse_command_plus"] == "signal" and kinds["X.position"] == "value" and kinds["note"] == "note"
    arrow = pytest.importorskip("pyarrow")
    table = machine.trace.to_arrow()
    assert isinstance(table, arrow.Table) and table.num_rows == len(columns["t"])


def test_the_trace_is_a_data_frame(machine):
    pytest.importorskip("pandas")
    machine.fault("X", "push", by=0.3)
    machine.fault("X", "drive_fault")
    machine.run("100ms")
    frame = machine.trace.to_pandas()
    assert set(frame.kind) >= {"signal", "alarm", "fault_set"}
    assert list(frame[frame.name == "push"].value) == [0.3]
