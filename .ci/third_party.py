"""Prints the packages inside the program with their licences and the texts of these, for a release: `third_party.py TARGET`."""

import json
import pathlib
import subprocess
import sys

metadata = json.loads(
    subprocess.run(
        ["cargo", "metadata", "--format-version", "1", "--locked", "--filter-platform", sys.argv[1]],
        check=True,
        capture_output=True,
        encoding="utf-8",
    ).stdout
)
packages = {package["id"]: package for package in metadata["packages"]}
nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
(root,) = [package["id"] for package in metadata["packages"] if package["name"] == "opennck"]
inside, waiting = set(), [root]
while waiting:
    for dependency in nodes[waiting.pop()]["deps"]:
        if dependency["pkg"] not in inside and any(kind["kind"] is None for kind in dependency["dep_kinds"]):
            inside.add(dependency["pkg"])
            waiting.append(dependency["pkg"])

texts = {}
print("OpenNCK contains these packages. Their licences are below.\n")
for package in sorted((packages[one] for one in inside), key=lambda package: (package["name"], package["version"])):
    name = f"{package['name']} {package['version']}"
    print(f"{name:40} {package['license']}")
    for file in sorted(pathlib.Path(package["manifest_path"]).parent.glob("*")):
        if file.is_file() and file.name.upper().startswith(("LICENSE", "LICENCE", "COPYING", "COPYRIGHT", "NOTICE", "UNLICENSE")):
            text = file.read_text(encoding="utf-8", errors="replace").strip()
            texts.setdefault(text, []).append(name)
for text, names in texts.items():
    print(f"\n{'=' * 100}\n{', '.join(names)}\n{'-' * 100}\n{text}")
