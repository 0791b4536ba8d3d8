"""Builds a wheel of the Python package from a build folder: wheel.py BUILD FOLDER. Needs no network and no pip.

The wheel has the module, liblimber, the libraries that it loads (without those of the system and of graphics drivers)
with their licenses, and the scenes. It is for the Python and the processor of the build, and for glibc as new as that
of the build. Prints the file's name.
"""

import base64
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import time
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
# the C and C++ library, and libraries of graphics drivers; as in package.sh
SYSTEM = re.compile(
    r"(ld-linux.*|lib(c|m|dl|pthread|rt|resolv|util|stdc\+\+|gcc_s|GL|EGL|GLX|OpenGL|GLdispatch|drm|gbm)\.so\..*|libwayland-.*)"
)
# packages with headers that become part of the module
COMPILED_IN = ("libglm-dev", "nlohmann-json3-dev", "libstb-dev", "libfmt-dev", "pybind11-dev")


def fail(text):
    sys.exit(f"wheel.py: {text}")


def run(*words):
    result = subprocess.run(words, capture_output=True, text=True, env={**os.environ, "LC_ALL": "C"})
    if result.returncode != 0:
        fail(f"{' '.join(words)} failed:\n{result.stdout}{result.stderr}")
    return result.stdout


def version():
    return re.search(r"project\(limber VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)


def numpy_requirement():
    """pybind11 before 2.12 can't use NumPy 2."""
    installed = run("dpkg-query", "-W", "-f", "${Version}", "pybind11-dev")
    old = tuple(map(int, re.match(r"(\d+)\.(\d+)", installed).groups())) < (2, 12)
    return "numpy>=1.21,<2" if old else "numpy>=1.21"


def metadata():
    python = f"{sys.version_info[0]}.{sys.version_info[1]}"
    return f"""Metadata-Version: 2.1
Name: limber
Version: {version()}
Summary: A live simulator of actuated, articulated bodies, as a library
License: MIT
Requires-Python: =={python}.*
Requires-Dist: {numpy_requirement()}
Description-Content-Type: text/markdown

{(ROOT / "docs/howto/python.md").read_text()}"""


def copy_license(package, folder):
    source = pathlib.Path("/usr/share/doc") / package / "copyright"
    if not source.exists():
        fail(f"the license of {package} was not found. apt-get install --reinstall {package}")
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source, folder / package)


def bundle_libraries(package, licenses):
    """Copies the libraries that the module loads; it finds them by its RPATH, and so do they."""
    folder = package / "lib"
    module = next(package.glob("_core.*.so"))
    for name, path in re.findall(r"^\s*(\S+) => (/\S+)", run("ldd", str(module)), re.MULTILINE):
        if SYSTEM.fullmatch(name) or pathlib.Path(path).is_relative_to(package):
            continue
        real = pathlib.Path(path).resolve()
        owner = subprocess.run(["dpkg-query", "-S", f"*/{real.name}"], capture_output=True, text=True).stdout
        if not owner:
            fail(f"{path} belongs to no package, so its license is unknown. Build with Debian's libraries.")
        shutil.copyfile(real, folder / name)
        run("strip", "--strip-unneeded", str(folder / name))
        copy_license(owner.split(":")[0], licenses)


def stage(build, tree):
    """Installs the package with its libraries and data. Returns the folder of the metadata."""
    run("cmake", "--install", str(build), "--component", "python", "--prefix", str(tree), "--strip")
    package, info = tree / "limber", tree / f"limber-{version()}.dist-info"
    for library in list((package / "lib").glob("liblimber.so.*")):  # a wheel has no links
        if library.is_symlink():
            real = library.resolve()
            library.unlink()
            real.rename(library)
    bundle_libraries(package, info / "licenses")
    for name in COMPILED_IN:
        copy_license(name, info / "licenses")
    shutil.copyfile(ROOT / "LICENSE", info / "licenses" / "LICENSE")
    for folder in ("scripts", "urdf", "behaviors_lua"):
        shutil.copytree(ROOT / folder, package / "share/limber" / folder)
    return info


def write(tree, info, out):
    tag = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    (info / "METADATA").write_text(metadata())
    (info / "WHEEL").write_text(
        f"Wheel-Version: 1.0\nGenerator: limber\nRoot-Is-Purelib: false\nTag: {tag}-{tag}-{platform}\n"
    )
    stamp = time.gmtime(max(int(os.environ.get("SOURCE_DATE_EPOCH") or 0), 315532800))[:6]
    record = []
    file = out / f"limber-{version()}-{tag}-{tag}-{platform}.whl"
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as wheel:

        def add(name, data, mode):
            entry = zipfile.ZipInfo(name, stamp)
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, (0o100000 | mode) << 16
            wheel.writestr(entry, data)

        for path in sorted(p for p in tree.rglob("*") if p.is_file()):
            name, data = path.relative_to(tree).as_posix(), path.read_bytes()
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record.append(f"{name},sha256={digest},{len(data)}\n")
            add(name, data, 0o755 if ".so" in path.name else 0o644)
        name = f"{info.name}/RECORD"
        add(name, "".join(record) + f"{name},,\n", 0o644)
    return file


def main():
    build, out = map(pathlib.Path, sys.argv[1:3])
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        tree = pathlib.Path(folder)
        print(write(tree, stage(build, tree), out))


main()
