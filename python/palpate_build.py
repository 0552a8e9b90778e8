"""Builds a wheel of palpate with cmake and ninja: a PEP 517 back end of the standard library alone, so that
`pip install .` needs no network."""

import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / f"wheel-{sys.implementation.cache_tag}"
PYTHON = f"cp{sys.version_info[0]}{sys.version_info[1]}"
TAG = f"{PYTHON}-{PYTHON}-{re.sub('[-.]', '_', sysconfig.get_platform())}"


def installed(staging):
    """Builds module and program, and installs them into a folder."""
    page = (ROOT / "web/node_modules/.package-lock.json").exists()  # else npm would ask the network for it
    # -O2 as Debian builds: sums over points are at -O3 all the same, and the rest compiles in a seventh less time.
    options = dict(CMAKE_BUILD_TYPE="Release", CMAKE_CXX_FLAGS_RELEASE="-O2 -DNDEBUG", CMAKE_UNITY_BUILD="ON", PALPATE_BUILD_TESTS="OFF", PALPATE_BUILD_EXAMPLES="OFF",
                   PALPATE_BUILD_PYTHON="ON", PALPATE_PYTHON=sys.executable, PALPATE_PYTHON_DIR=".",
                   PALPATE_BUILD_PAGE="ON" if page else "OFF")
    subprocess.run(["cmake", "-S", ROOT, "-B", BUILD, "-G", "Ninja", *(f"-D{k}={v}" for k, v in options.items())], check=True)
    subprocess.run(["cmake", "--build", BUILD, "-j", str(os.cpu_count()), "-t", "palpate_python", "palpate_app"], check=True)
    subprocess.run(["cmake", "--install", BUILD, "--prefix", staging, "--component", "python"], check=True)
    return BUILD / "apps/palpate/palpate"


def description():
    """Files of a wheel's dist-info folder, and that folder's name."""
    version = re.search(r"project\(palpate VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
    metadata = (f"Metadata-Version: 2.1\nName: palpate\nVersion: {version}\nSummary: Feel a point cloud\n"
                "Requires-Python: >=3.9\nRequires-Dist: numpy\n")
    wheel = f"Wheel-Version: 1.0\nGenerator: palpate\nRoot-Is-Purelib: false\nTag: {TAG}\n"
    return f"palpate-{version}", {"METADATA": metadata.encode(), "WHEEL": wheel.encode(),
                                  "LICENSE": (ROOT / "LICENSE").read_bytes()}


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    name, files = description()
    info = pathlib.Path(metadata_directory, f"{name}.dist-info")
    info.mkdir()
    for file, data in files.items():
        (info / file).write_bytes(data)
    return info.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    name, info = description()
    with tempfile.TemporaryDirectory() as staging, zipfile.ZipFile(
            pathlib.Path(wheel_directory, f"{name}-{TAG}.whl"), "w", zipfile.ZIP_DEFLATED) as wheel:
        program = installed(staging)
        files = {str(path.relative_to(staging)): path.read_bytes() for path in sorted(pathlib.Path(staging).rglob("*.*"))}
        files[f"{name}.data/scripts/palpate"] = program.read_bytes()
        files.update({f"{name}.dist-info/{file}": data for file, data in info.items()})
        record = ""
        for path, data in files.items():
            entry = zipfile.ZipInfo(path)
            entry.external_attr = (0o100755 if "/scripts/" in path else 0o100644) << 16
            wheel.writestr(entry, data, zipfile.ZIP_DEFLATED)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record += f"{path},sha256={digest},{len(data)}\n"
        wheel.writestr(f"{name}.dist-info/RECORD", f"{record}{name}.dist-info/RECORD,,\n")
    return f"{name}-{TAG}.whl"
