"""What a release says of itself: one version, a citation that can be read."""

import re
from pathlib import Path

import propmdao


def test_citation_changelog_and_package_have_one_version(checkout: Path) -> None:
    citation = (checkout / "CITATION.cff").read_text(encoding="utf-8")
    fields = dict(re.findall(r"^([a-z-]+): (.*)$", citation, re.M))
    assert fields["version"] == propmdao.__version__
    assert fields["cff-version"] == "1.2.0" and fields["license"] == "Apache-2.0"
    changelog = (checkout / "CHANGELOG.md").read_text(encoding="utf-8")
    newest = re.search(r"^## \[(.*?)\]", changelog, re.M)
    assert newest is not None
    released = "dev" not in propmdao.__version__
    assert newest[1] == (propmdao.__version__ if released else "Unreleased")
