"""The canonical form: what is chance in a run is gone, what is content stays."""

from pathlib import Path

from notebook_reports.run.canonical import canonical, dump, renew_prose

ROOT = Path("/somewhere/project")


def code(*outputs, text="x", **metadata):
    return {
        "cell_type": "code",
        "id": "r",
        "metadata": metadata,
        "source": text,
        "execution_count": 1,
        "outputs": [*outputs],
    }


def stream(text, name="stdout"):
    return {"output_type": "stream", "name": name, "text": text}


def made(*cells, **metadata):
    return canonical({"cells": list(cells), "metadata": metadata}, ROOT, [f"c{i}" for i, _ in enumerate(cells, 1)])


def test_times_and_versions_go():
    cell = code(papermill={"duration": 1.5}, execution={"iopub.status.busy": "2026"}, tags=["keep"])
    result = made(cell, papermill={"output_path": "/tmp/x"}, language_info={"name": "python", "version": "3.11.7"})
    assert result["cells"][0]["metadata"] == {"tags": ["keep"]}
    assert result["cells"][0]["id"] == "c1"
    assert set(result["metadata"]) == {"kernelspec", "language_info"}
    assert "3.11" not in dump(result).decode()


def test_streams_are_joined_between_other_outputs():
    shown = {"output_type": "display_data", "metadata": {}, "data": {"text/plain": "1"}}
    cell = code(stream("a\n"), stream("w\n", "stderr"), stream("b\n"), shown, stream("c\n"))
    outputs = made(cell)["cells"][0]["outputs"]
    assert [o.get("text") for o in outputs] == ["a\nb\n", "w\n", None, "c\n"]


def test_addresses_temporary_files_and_folders_are_masked():
    text = (
        "<object at 0x7f3a5c2b1d90> 0xFF\n"
        "/tmp/ipykernel_4711/1234567.py:1: UserWarning: hm\n"
        "/somewhere/project/src/loopbook/loop.py:12: RuntimeWarning: hm\n"
    )
    (output,) = made(code(stream(text, "stderr")))["cells"][0]["outputs"]
    assert output["text"] == (
        "<object at 0x…> 0xFF\n<cell>:1: UserWarning: hm\nsrc/loopbook/loop.py:12: RuntimeWarning: hm\n"
    )


def test_an_output_of_five_megabytes_on_one_line_is_no_obstacle():
    text = "x" * 5_000_000 + " /tmp/ipykernel_1/2.py:1 " + "/y" * 100_000
    (output,) = made(code(stream(text)))["cells"][0]["outputs"]
    assert output["text"] == text.replace("/tmp/ipykernel_1/2.py", "<cell>")


def test_data_for_programs_is_not_touched():
    data = {"application/vnd.loopbook.table+json": {"rows": [["0x7f3a5c2b1d90"]]}, "image/png": "aGVq\n"}
    (output,) = made(code({"output_type": "display_data", "metadata": {}, "data": data}))["cells"][0]["outputs"]
    assert output["data"] == data


def test_colours_of_a_traceback_go():
    error = {"output_type": "error", "ename": "E", "evalue": "v", "traceback": ["\x1b[0;31mE\x1b[0m: v"]}
    (output,) = made(code(error))["cells"][0]["outputs"]
    assert output["traceback"] == ["E: v"]


def test_prose_is_renewed_around_the_results():
    def prose(text):
        return {"cell_type": "markdown", "id": "m", "metadata": {}, "source": text}

    injected = code(text="q = 0.6", tags=["injected-parameters"])
    ran = canonical({"cells": [prose("old"), code(stream("1")), injected], "metadata": {}}, ROOT, ["m", "c1"])
    plain = canonical({"cells": [prose("new"), code(), prose("more")], "metadata": {}}, ROOT, ["m", "c1", "n"])
    result = renew_prose(ran, plain)
    assert [c["source"] for c in result["cells"]] == ["new", "x", "q = 0.6", "more"]
    assert result["cells"][1]["outputs"] == [stream("1")]
