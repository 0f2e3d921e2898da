"""Scenario files: `run`, `test`, and the plugin for pytest."""

import pathlib

import opennck
import pytest

pytest_plugins = ["pytester"]

SCENARIO = """title   = "A key moves the axis"
machine = "g1_example"
plc     = "enable_all"
covers  = ["REF-02"]
watch   = ["X.traverse_command_plus"]
[[step]]
note   = "enabled"
wait   = "X.position_controller_active"
within = "1s"
[[step]]
set    = { "X.traversing_key_plus" = 1 }
[[step]]
wait   = "X.position > LIMIT"
within = "2s"
[[step]]
expect = "alarms() == 0"
"""


@pytest.fixture
def scenario(tmp_path):
    file = tmp_path / "key.toml"
    file.write_text(SCENARIO.replace("LIMIT", "5"))
    return file


def test_a_scenario_passes(scenario):
    result = opennck.run(scenario)
    assert result.ok and result.verdict == "passed" and result.message == "" and result.check() is result
    assert [(step.line, step.note, step.state) for step in result.steps] == [
        (6, "enabled", "done"),
        (10, None, "done"),
        (12, None, "done"),
        (15, None, "done"),
    ]
    assert result.get("X.position") > 5 and result.time > 0.2
    assert any(row.get("symbol") == "X.traverse_command_plus" for row in result.trace)
    assert result._repr_svg_().startswith("<svg") and "A key moves the axis" in result.trace.text()


def test_a_step_that_fails_is_a_result(scenario):
    scenario.write_text(SCENARIO.replace("LIMIT", "5000"))
    result = opennck.run(scenario)
    assert result.verdict == "failed" and not result.ok
    assert result.message.startswith(f"{scenario}:12: ") and "X.position = " in result.message
    assert [step.state for step in result.steps] == ["done", "done", "failed", "not reached"]
    with pytest.raises(opennck.Missed, match="X.position"):
        result.check()


def test_an_unusable_scenario_is_an_error(scenario):
    scenario.write_text(SCENARIO.replace("LIMIT", "nothing"))
    with pytest.raises(opennck.Error, match="key.toml:13"):
        opennck.run(scenario)


def test_a_case_is_selected(scenario):
    scenario.write_text(SCENARIO.replace("LIMIT", "5").replace("[[step]]", '[matrix]\n"37110[X]" = [0.5, 1.0]\n[[step]]', 1))
    with pytest.raises(opennck.Error, match="found 2 of 2"):
        opennck.run(scenario)
    assert opennck.run(scenario, case="= 0.5").ok


def test_a_scenario_names_a_function(scenario):
    def own(io):
        for axis in io.axes:
            for signal in ("position_measuring_system_1", "controller_enable", "pulse_enable"):
                io[f"{axis}.{signal}"] = 1

    scenario.write_text(SCENARIO.replace("LIMIT", "5").replace("enable_all", "own"))
    assert opennck.run(scenario, programs={"own": own}).ok
    with pytest.raises(opennck.Error, match="`own`"):
        opennck.run(scenario)


def test_a_trace_is_compared_with_its_golden_file(scenario):
    verdict = lambda **options: [result.verdict for result in opennck.test(scenario.parent, **options)]
    assert verdict() == ["missing"]
    assert verdict(accept=True) == ["accepted"]
    assert verdict() == ["passed"]
    assert verdict(check_causes=True) == ["passed"]
    golden = scenario.with_suffix(".snap")
    golden.write_text(golden.read_text().replace("0 -> 1", "1 -> 0"))
    (result,) = opennck.test(scenario)
    assert result.verdict == "differs" and "X.traverse_command_plus" in result.message


def test_the_plugin_collects_scenarios(pytester, scenario):
    folder = pytester.mkdir("golden")
    (folder / "key.toml").write_text(SCENARIO.replace("LIMIT", "5"))
    pytester.path.joinpath("other.toml").write_text("a = 1\n")
    pytester.makeini("[pytest]\nopennck_scenarios = golden\n")
    first = pytester.runpytest_subprocess()
    first.assert_outcomes(failed=1)
    first.stdout.fnmatch_lines(["*golden file *key.snap does not exist*"])
    pytester.runpytest_subprocess("--opennck-accept").assert_outcomes(passed=1)
    pytester.runpytest_subprocess("--junit-xml=report.xml").assert_outcomes(passed=1)
    assert '<property name="rule" value="REF-02"' in pytester.path.joinpath("report.xml").read_text()
    golden = folder / "key.snap"
    golden.write_text(golden.read_text().replace("0 -> 1", "1 -> 0"))
    differs = pytester.runpytest_subprocess()
    differs.assert_outcomes(failed=1)
    differs.stdout.fnmatch_lines(["*the trace differs from the golden file: *"])


def test_the_plugin_finds_a_golden_file_beside_a_scenario(pytester):
    pytester.path.joinpath("key.toml").write_text(SCENARIO.replace("LIMIT", "5").replace("[[step]]", '[matrix]\n"37110[X]" = [0.5, 1.0]\n[[step]]', 1))
    pytester.runpytest_subprocess().assert_outcomes()
    opennck.test(pytester.path / "key.toml", accept=True)
    pytester.runpytest_subprocess("-v", "--opennck-check-causes").assert_outcomes(passed=2)


def test_the_plugin_names_what_cannot_be_used(pytester):
    folder = pytester.mkdir("golden")
    (folder / "key.toml").write_text("title = 1\n[[step]]\nrun = '1s'\n")
    result = pytester.runpytest_subprocess("-o", "opennck_scenarios=golden")
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(["*key.toml:1: *"])
    pytester.runpytest_subprocess("-o", "opennck_scenarios=nowhere").stderr.fnmatch_lines(["*nowhere does not exist*"])


def test_the_module_for_plc_processes_is_the_one_of_the_examples():
    import opennck.image

    example = pathlib.Path(__file__).parents[2] / "examples/python_plc/opennck_image.py"
    assert pathlib.Path(opennck.image.__file__).read_text() == example.read_text()
