"""What is promised of a build is held by tests: each sentence of docs/security.md, each subject of the list below."""

import ast
import re
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PRESS = "tests/notebook_reports/"
SENTENCES = re.findall(
    r"^- (.+?) <!-- (\S+?)::(\w+) -->$", (ROOT / "docs/security.md").read_text(encoding="utf-8"), re.MULTILINE
)
SUBJECTS = {
    "a short or empty home": ("run/test_masks.py", "test_a_home_too_short_to_be_told_from_text_is_not_masked"),
    "a home in a stamp": ("run/test_masks.py", "test_a_home_that_outputs_show_is_part_of_the_stamp"),
    "paths masked whole": ("run/test_masks.py", "test_only_whole_paths_are_masked"),
    "a changed cache": ("memory/test_cache.py", "test_a_damaged_entry_is_a_miss"),
    "a fuzz of the cache": ("memory/test_cache.py", "test_a_seeded_fuzz_of_the_whole_cache"),
    "reading that is seen": (
        "run/test_watching.py",
        "test_a_change_of_what_was_read_runs_the_notebook_again_and_no_other",
    ),
    "reading outside": ("run/test_watching.py", "test_reading_outside_the_project_is_said"),
    "declared inputs": ("run/test_watching.py", "test_what_another_program_reads_is_not_seen_and_can_be_declared"),
    "a flipped report": (
        "memory/test_cache.py",
        "test_a_changed_report_is_written_again_though_size_and_time_are_kept",
    ),
    "one file name for two values": ("build/test_names.py", "test_other_parameters_have_another_file"),
    "every failure repeated": ("build/test_names.py", "test_every_failure_is_repeated_and_so_are_the_options"),
    "drawings that run": ("export/test_sanitise.py", "test_a_drawing_that_would_run_or_fetch_is_refused"),
    "HTML of outputs": ("export/test_sanitise.py", "test_html_of_outputs_is_written_anew_or_refused"),
    "scripts of packages": (
        "export/test_sanitise.py",
        "test_a_script_comes_from_an_installed_package_and_its_hash_is_in_the_policy",
    ),
    "a real browser": ("export/test_browser.py", "test_nothing_that_an_output_holds_runs_or_is_fetched"),
    "foreign folders": ("project/test_owner.py", "test_a_design_runs_nothing_of_the_folder_it_is_called_in"),
    "foreign projects": ("project/test_owner.py", "test_a_project_of_another_user_is_used_where_it_is_named"),
    "foreign temporary folders": ("project/test_owner.py", "test_a_cache_made_beforehand_by_another_user_is_not_used"),
    "no shell for data": ("project/test_owner.py", "test_make_passes_no_text_of_its_caller_to_a_shell_as_a_command"),
    "images outside": ("export/test_sanitise.py", "test_an_image_outside_the_project_is_refused"),
    "escape sequences": ("project/test_names_of_data.py", "test_what_a_terminal_would_obey_is_written_out"),
    "names of data": ("project/test_names_of_data.py", "test_a_name_of_data_is_text_in_a_report"),
    "broken notebooks": (
        "project/test_broken_input.py",
        "test_a_broken_notebook_is_one_failure_and_the_others_are_built",
    ),
    "broken TOML": ("project/test_broken_input.py", "test_a_broken_toml_file_is_one_line"),
    "broken models": ("project/test_broken_input.py", "test_a_broken_model_is_one_line"),
    "a build elsewhere": ("build/test_names.py", "test_a_build_elsewhere_leaves_the_projects_reports_alone"),
    "a warm process killed": (
        "run/test_robust.py",
        "test_notebooks_of_a_warm_process_that_was_killed_run_in_fresh_kernels",
    ),
    "an interrupted warm-up": ("run/test_robust.py", "test_an_interruption_of_the_warm_up_is_obeyed_at_once"),
    "folders of killed runs": ("run/test_robust.py", "test_what_a_killed_process_left_is_removed_by_the_next"),
    "limits": ("run/test_robust.py", "test_too_few_files_or_too_little_memory_are_said_before_work"),
    "a read-only project": ("run/test_robust.py", "test_in_a_project_that_cannot_be_written_the_advice_given_works"),
    "no home, no name": ("run/test_robust.py", "test_without_a_home_and_without_a_name_in_the_list_of_users"),
    "a time limit that is none": ("project/test_broken_input.py", "test_a_time_limit_is_a_number_of_seconds"),
    "numbers as one writes them": (
        "project/test_broken_input.py",
        "test_a_value_that_is_not_written_as_one_is_refused",
    ),
    "children left": ("run/test_robust.py", "test_a_child_that_a_cell_left_running_is_ended_and_named"),
    "the umask": ("run/test_robust.py", "test_the_umask_is_respected"),
    "doctor writes nothing": ("run/test_robust.py", "test_doctor_writes_nothing"),
    "warnings of libraries": ("run/test_masks.py", "test_builds_under_other_homes_and_users_words_give_the_same_bytes"),
    "builds under two of everything": ("test_cli.py", "test_verify_builds_under_two_of_everything"),
    "provenance": ("build/test_provenance.py", "test_a_comparison_says_what_differs"),
    "chaos": ("build/test_chaos.py", "test_faults_leave_nothing_wrong_that_the_next_build_does_not_mend"),
}


@cache
def _tests_of(path: str) -> dict[str, int]:
    """The tests of a file, with the number of assertions in each."""
    tree = ast.parse((ROOT / path).read_text(encoding="utf-8"))
    functions = [n for n in ast.walk(tree) if isinstance(n, ast.FunctionDef) and n.name.startswith("test_")]
    return {f.name: sum(_asserts(n) for n in ast.walk(f)) for f in functions}


def _asserts(node: ast.AST) -> bool:
    """Is it an assertion, a block that expects an error, or a call of a function that asserts?"""
    calls = isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id.startswith("assert_")
    expects = isinstance(node, ast.With) and "raises" in ast.unparse(node.items[0])
    return isinstance(node, ast.Assert) or calls or expects


@pytest.mark.parametrize(("sentence", "path", "name"), SENTENCES, ids=[name for _, _, name in SENTENCES])
def test_a_sentence_on_security_has_its_test(sentence, path, name):
    assert _tests_of(path).get(name), f"{path} has no test {name} that asserts something, for: {sentence}"


def test_every_sentence_of_the_page_names_a_test():
    page = (ROOT / "docs/security.md").read_text(encoding="utf-8")
    assert len(SENTENCES) == len(re.findall(r"^- ", page, re.MULTILINE)) > 20
    assert len(re.sub(r"<!--.*?-->", "", page).split()) < 900  # one page


@pytest.mark.parametrize("subject", SUBJECTS)
def test_a_subject_has_its_test(subject):
    path, name = SUBJECTS[subject]
    assert _tests_of(PRESS + path).get(name), f"{subject}: {path} has no test {name} that asserts something"
