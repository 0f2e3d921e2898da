"""Where the program `opennck` is."""

import os
import shutil
import sys
import sysconfig


def program() -> str:
    """The path of the program `opennck` that was installed with this module, or else of the one on the search path."""
    name = "opennck.exe" if os.name == "nt" else "opennck"
    folders = [sysconfig.get_path("scripts"), os.path.dirname(sys.executable)]
    user = sysconfig.get_preferred_scheme("user")
    if user in sysconfig.get_scheme_names():
        folders.append(sysconfig.get_path("scripts", user))
    for folder in folders:
        path = os.path.join(folder, name)
        if os.path.isfile(path):
            return path
    found = shutil.which(name)
    if found is None:
        raise FileNotFoundError(f"there is no program {name} in {folders[0]}, nor on the search path; install it with `pip install opennck`")
    return found
