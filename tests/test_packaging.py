"""What is promised about the package as a whole: names, version, dependencies, bundle, hosts."""

import ast
import importlib
import importlib.metadata
import json
import re
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

import hatch_build

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
PUBLIC_NAMES = importlib.import_module("rigid").__all__


def distribution(requirement: str) -> str:
    """The name in `requirement`, as registries spell it: `A_b[c]>=1` is `a-b`."""
    name = re.match(r"[\w.-]+", requirement)
    assert name, requirement
    return re.sub(r"[-_.]+", "-", name.group()).lower()


def distributions(requirements: list[str]) -> set[str]:
    return {distribution(requirement) for requirement in requirements} - {"rigid-frontier"}


RUN_TIME = distributions(PROJECT["project"]["dependencies"])
EXTRAS = {
    name: distributions(requirements)
    for name, requirements in PROJECT["project"]["optional-dependencies"].items()
}


@pytest.mark.parametrize("name", PUBLIC_NAMES)
def test_every_public_name_exists(name):
    assert hasattr(importlib.import_module("rigid"), name)


def test_the_installed_version_is_the_version_in_the_source():
    version = importlib.import_module("rigid._version").__version__
    assert importlib.metadata.version("rigid-frontier") == version


def test_the_version_is_semantic_in_the_spelling_of_python():
    version = importlib.import_module("rigid._version").__version__
    assert re.fullmatch(r"\d+\.\d+\.\d+((a|b|rc)\d+)?(\.dev\d+)?", version)


def test_every_dependency_is_explained_in_one_line_and_nothing_else_is():
    declared = RUN_TIME.union(*EXTRAS.values())
    declared |= distributions([*PROJECT["build-system"]["requires"], hatch_build.NODE])
    front_end = json.loads((ROOT / "web" / "package.json").read_text())
    declared |= set(front_end["dependencies"]) | set(front_end["devDependencies"])

    page = (ROOT / "docs" / "dependencies.md").read_text()
    explained = re.findall(r"^- `([^`]+)`: ", page, re.MULTILINE)
    assert sorted(explained) == sorted(declared)


def third_party_imports() -> dict[str, str]:
    """Every top-level module that src/ imports from elsewhere, with one file that does."""
    imported = {}
    for path in sorted((ROOT / "src").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text())):
            match node:
                case ast.Import():
                    modules = [alias.name for alias in node.names]
                case ast.ImportFrom(level=0):
                    modules = [node.module or ""]
                case _:
                    continue
            imported |= {module.partition(".")[0]: path.name for module in modules}
    return {
        module: file
        for module, file in imported.items()
        if module != "rigid" and module not in sys.stdlib_module_names
    }


def test_src_imports_nothing_that_users_were_not_told_to_install():
    provided = importlib.metadata.packages_distributions()
    extras = ("minari", "onnx", "ray", "sb3", "video")
    allowed = RUN_TIME.union(*(EXTRAS[name] for name in extras))
    undeclared = {
        module: file
        for module, file in third_party_imports().items()
        if not distributions(provided.get(module, [module])) & allowed
    }
    assert undeclared == {}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The wheel of this checkout, built with the tools of this environment."""
    folder = tmp_path_factory.mktemp("dist")
    command = [sys.executable, "-m", "hatchling", "build", "--target", "wheel", "-d", str(folder)]
    subprocess.run(command, cwd=ROOT, check=True, timeout=300)
    return next(folder.glob("*.whl"))


def test_the_wheel_carries_the_report_and_its_types(wheel):
    names = set(zipfile.ZipFile(wheel).namelist())
    assert {
        "rigid/report/static/report.js",
        "rigid/report/static/report.css",
        "rigid/py.typed",
    } <= names


def test_the_wheel_carries_what_a_study_is_served_from(wheel):
    names = set(zipfile.ZipFile(wheel).namelist())
    protocols = ("exhaustiveness", "faithfulness", "danger", "naturalness")
    assert {
        "rigid/report/static/study.js",
        "rigid/report/static/study.css",
        "rigid/study/page.html",
        "rigid/study/texts/en.json",
        *(f"rigid/study/protocols/paper-{name}.yaml" for name in protocols),
        *(f"rigid/study/service/admin.{kind}" for kind in ("html", "css", "js")),
        "rigid/study/analysis/study.html",
        "rigid/tasks/itch_scratching/posture.npz",
    } <= names


def test_the_wheel_carries_no_tests_and_no_sources_of_the_bundle(wheel):
    names = zipfile.ZipFile(wheel).namelist()
    assert {name.partition("/")[0] for name in names} == {
        "rigid",
        f"rigid_frontier-{importlib.metadata.version('rigid-frontier')}.dist-info",
    }


@pytest.fixture
def checkout(tmp_path):
    """A project whose bundle was made from the web sources that lie there."""
    web, bundle = tmp_path / "web", tmp_path / hatch_build.BUNDLE
    (web / "src").mkdir(parents=True)
    bundle.mkdir(parents=True)
    (web / "package.json").write_text("{}")
    (web / "src" / "main.ts").write_text("export {}")
    for name in hatch_build.BUNDLED_FILES:
        (bundle / name).touch()
    (bundle / hatch_build.HASH_FILE).write_text(hatch_build.source_hash(web))
    return tmp_path


class TestBundle:
    """When the front end is bundled again, and when not."""

    def test_an_unchanged_source_is_not_bundled_again(self, checkout):
        assert hatch_build.is_bundle_current(checkout)

    @pytest.mark.parametrize("file", ["src/main.ts", "src/new.css", "package-lock.json"])
    def test_a_changed_or_new_source_is_bundled_again(self, checkout, file):
        (checkout / "web" / file).write_text("changed")
        assert not hatch_build.is_bundle_current(checkout)

    def test_a_renamed_source_is_bundled_again(self, checkout):
        main = checkout / "web" / "src" / "main.ts"
        main.rename(main.with_name("other.ts"))
        assert not hatch_build.is_bundle_current(checkout)

    def test_a_missing_part_of_the_bundle_is_made_again(self, checkout):
        (checkout / hatch_build.BUNDLE / "report.css").unlink()
        assert not hatch_build.is_bundle_current(checkout)

    @pytest.mark.parametrize("folder", ["node_modules", "build", "tests"])
    def test_installed_packages_and_tests_do_not_shape_the_bundle(self, checkout, folder):
        (checkout / "web" / folder).mkdir()
        (checkout / "web" / folder / "index.js").touch()
        assert hatch_build.is_bundle_current(checkout)

    def test_a_bundle_without_its_source_is_taken_as_it_is(self, checkout):
        (checkout / "web" / "package.json").unlink()
        assert hatch_build.is_bundle_current(checkout)

    def test_neither_source_nor_bundle_is_an_error_that_names_both_places(self, tmp_path):
        with pytest.raises(FileNotFoundError, match=r"neither its source .*web nor its bundle"):
            hatch_build.is_bundle_current(tmp_path)


def test_no_file_of_the_project_names_a_package_registry():
    """Mirrors and offline machines install from elsewhere: the clients know where."""
    hosts = re.compile(r"\b(pypi|pythonhosted|npmjs|debian)[.](org|com)\b")
    tracked = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],  # noqa: S607 - whose git, PATH says.
        cwd=ROOT,
        check=False,
        capture_output=True,
        text=True,
        timeout=60,
    )
    if tracked.returncode:
        pytest.skip("no git checkout: which files belong to the project is not known")
    offenders = [
        name
        for name in tracked.stdout.split("\0")
        if (path := ROOT / name).is_file()
        and hosts.search(path.read_text(encoding="utf-8", errors="ignore"))
    ]
    assert offenders == []
