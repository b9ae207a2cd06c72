"""Records of what was done: believed only as they were written, of the same job, sources and packages."""

import json

import pytest

from notebook_reports.executors import done
from notebook_reports.executors.done import DoneJobs


@pytest.mark.parametrize(
    "damage", [lambda r: r["noted"].update(points=9), lambda r: r.pop("seal"), lambda r: r.update(job="0" * 64)]
)
def test_a_record_that_was_changed_is_not_believed(damage, tmp_path, monkeypatch):
    jobs = DoneJobs(tmp_path, tmp_path / "records", ("notebook_reports",))
    jobs.note("s1/lag", ("job",), {"points": 1}, {})
    assert jobs.find("s1/lag", ("job",)) == {"points": 1}
    assert jobs.find("s1/lag", ("another",)) is None and jobs.find("s2/lag", ("job",)) is None
    path = tmp_path / "records" / "s1" / "lag.json"
    record = json.loads(path.read_text())
    damage(record)
    path.write_text(json.dumps(record))
    assert jobs.find("s1/lag", ("job",)) is None
    jobs.note("s1/lag", ("job",), {"points": 1}, {})
    monkeypatch.setattr(done, "fingerprint", lambda packages: {"Python": "3.99"})
    assert jobs.find("s1/lag", ("job",)) is None
