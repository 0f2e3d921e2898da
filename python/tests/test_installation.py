"""The files for CI and for releases: they are read as what they are, their commands exist, and those for users run."""

import pathlib
import re
import shlex
import shutil
import subprocess
import tomllib

import opennck
import pytest

yaml = pytest.importorskip("yaml")

PROJECT = pathlib.Path(__file__).parents[2]
FOR_USERS = sorted((PROJECT / "examples/ci").glob("*.yml"))
FILES = [*FOR_USERS, *sorted((PROJECT / ".github/workflows").glob("*.yml"))]


def commands(file):
    """The lines that a shell executes."""
    document = yaml.safe_load(file.read_text())
    jobs = document.get("jobs", document)
    for job in jobs.values():
        if not isinstance(job, dict):
            continue
        steps = job.get("script", []) + [step["run"] for step in job.get("steps", []) if "run" in step]
        for step in steps:
            yield from (line for line in step.splitlines() if line.strip())


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_each_command_exists(file):
    lines = list(commands(file))
    assert lines, "no command was found"
    for line in lines:
        words = shlex.split(line)
        if words[0] == "opennck":
            shown = subprocess.run([opennck.program(), words[1], "--help"], capture_output=True, text=True, check=True).stdout
            for option in (word.split("=")[0] for word in words if word.startswith("--")):
                assert re.search(rf"{option}\b", shown), f"{line}: `opennck {words[1]}` has no {option}"
        elif "/" in words[0]:
            assert (PROJECT / words[0]).stat().st_mode & 0o111, f"{line}: not a program"


@pytest.mark.parametrize("file", [file for file in FOR_USERS if "release" not in file.name], ids=lambda file: file.name)
def test_the_files_for_users_run_in_an_empty_folder(file, tmp_path):
    for folder in ("golden/jog", "machine_data"):
        shutil.copytree(PROJECT / folder, tmp_path / folder)
    program = pathlib.Path(opennck.program()).parent
    for line in commands(file):
        if line.startswith("pip "):
            continue  # it is installed
        done = subprocess.run(
            line, shell=True, cwd=tmp_path, env={"PATH": f"{program}:/usr/bin:/bin"}, capture_output=True, text=True
        )
        assert done.returncode == 0, f"{line}\n{done.stdout}{done.stderr}"
    assert "testcase" in (tmp_path / "report.xml").read_text()


def test_binstall_finds_the_archive_that_is_made():
    manifest = tomllib.loads((PROJECT / "Cargo.toml").read_text())
    binstall = manifest["package"]["metadata"]["binstall"]
    archive = (PROJECT / ".ci/archive").read_text()
    assert binstall["pkg-url"].endswith("/opennck-{ version }-{ target }.tar.gz")
    assert binstall["bin-dir"] == "opennck-{ version }-{ target }/{ bin }{ binary-ext }"
    assert "name=opennck-$version-$target\n" in archive and '"$folder/$name/opennck"' in archive


def test_the_versions_are_the_same():
    versions = {
        tomllib.loads((PROJECT / path).read_text())["package"]["version"] for path in ("Cargo.toml", "python/Cargo.toml")
    }
    assert versions == {opennck.__version__}


def test_the_examples_of_the_pages_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"^```(\w+)\n(.*?)^```$", (PROJECT / "docs/python.md").read_text(), re.DOTALL | re.MULTILINE)
    for language, text in blocks:
        if language == "toml" and text.startswith("# my.toml"):
            (tmp_path / "my.toml").write_text(text)
    (readme,) = re.findall(r"^```python\n(.*?)^```$", (PROJECT / "README.md").read_text(), re.DOTALL | re.MULTILINE)
    (package,) = re.findall(r"^```python\n(.*?)^```$", (PROJECT / "python/README.md").read_text(), re.DOTALL | re.MULTILINE)
    examples = [text for language, text in blocks if language == "python"]
    assert len(examples) >= 5
    for text in [*examples, readme, package]:
        exec(compile(text, "example", "exec"), {})


def test_the_page_names_every_method_of_a_session():
    text = (PROJECT / "docs/python.md").read_text()
    for cls in (opennck.Session, opennck.Trace):
        for name in vars(cls):
            if not name.startswith("_"):
                assert re.search(rf"`{name}\b|\b{name}\(|\.{name}\b", text), f"docs/python.md does not name {name}"
