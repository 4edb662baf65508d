#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Changes the code in one place at a time and reports the share of changes that some test notices.

usage: mutate.py [--per-folder N] [--seed S] [--folder FOLDER ...] [--jobs N]

Works in a copy of the last commit, under build/mutation. Changes are sampled reproducibly: an
operator, a constant, a condition or a return value. A change that does not compile is drawn again.
Each is judged by the tests of its folder, then by whole localizations.

A number is not changed where memory is taken: one element more makes no difference, one less is a
change of an operator. The changed file checks the bounds of its lists: where it reads beyond them,
the sanitizers' runs of the same tests would stop. A program that takes five times as long as on the
unchanged tree, and a minute more, counts as one that notices.
"""

import argparse
import random
import re
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "build" / "mutation"
BUILD = SOURCE / "build" / "release"  # as the tree's own, so that a compiler cache knows its files

# The programs that test a folder, the quick ones first, some with a filter.
CORE_LAST = ["search_test", "localizer_test SameBits.*:Localizer.*:Cameras/*"]
WITH_FILES = "review_test ValidatedPose.*:SignedPose.*:WholeCase.*"  # minutes
WITHOUT_FILES = WITH_FILES.replace(" ", " -")
TESTS = {
    "core/accept": ["accept_test"] + CORE_LAST,
    "core/base": ["base_test", "geometry_test"] + CORE_LAST,
    "core/edges": ["edges_test", "edges_opencv_test"] + CORE_LAST,
    "core/geometry": ["geometry_test", "geometry_opencv_test"] + CORE_LAST,
    "core/localizer": ["localizer_test", "record_test"],
    "core/match": ["match_test", "match_opencv_test"] + CORE_LAST,
    "core/pnp": ["pnp_test", "pnp_opencv_test"] + CORE_LAST,
    "core/record": ["record_test", "onboard_record_test"],
    "core/refine": ["refine_test"] + CORE_LAST,
    "core/render": ["core_render_tests"] + CORE_LAST,
    "core/search": CORE_LAST,
    "core/templates": ["templates_test"] + CORE_LAST,
    "core/views": ["views_test"],
    "sessions/annotation": ["annotation_test", "session_test"],
    "sessions/checks": ["checks_test"],
    "sessions/decision": ["decision_test", "queue_test", WITHOUT_FILES],
    "sessions/evaluation": ["evaluation_test"],
    "sessions/record": ["onboard_record_test"],
    "sessions/review": ["queue_test", WITHOUT_FILES, "session_test SessionOfResults.*", WITH_FILES],
    "sessions/session": ["session_test", "queue_test"],
}
CHECKS = "#define _GLIBCXX_ASSERTIONS 1\n"

SWAPS = {
    "<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "&&": "||", "||": "&&",
    "+": "-", "-": "+", "*": "/", "/": "*", "+=": "-=", "-=": "+=", "*=": "/=", "++": "--",
}
OPERATOR = re.compile(r"(?<=[\w)\]] )(<=|>=|==|!=|&&|\|\||\+=|-=|\*=|<|>|\+|-|\*|/)(?= [\w(!-])")
NUMBER = re.compile(r"(?<![\w.])(\d+\.\d+|\d+)(?![\w.'])")
CONDITION = re.compile(r"\b(if|while) \((?!constexpr)(.*)\)(?= (return|continue|break|\{|[a-z]\w* )|$| \{)")
RETURN = re.compile(r"\breturn (true|false|0|\w[\w.]*\(\)|\w+);")


def code_of(line):
    """The line with comments and strings blanked, of the same length."""
    line = re.sub(r'"(\\.|[^"\\])*"', lambda m: " " * len(m.group()), line)
    line = re.sub(r"'(\\.|[^'\\])'", lambda m: " " * len(m.group()), line)
    at = line.find("//")
    return line if at < 0 else line[:at] + " " * (len(line) - at)


def changes_of(line):
    """All (what, changed line) of a line."""
    code = code_of(line)
    if code.lstrip().startswith(("#", "static_assert", "using", "template", "namespace", "case")):
        return
    for m in OPERATOR.finditer(code):
        swapped = SWAPS[m.group()]
        yield f"{m.group()} to {swapped}", line[:m.start()] + swapped + line[m.end():]
    for m in NUMBER.finditer("" if "allocate" in code else code):
        text = m.group()
        changed = repr(2.0 * float(text) + 1.0) if "." in text else str(int(text) + 1)
        yield f"{text} to {changed}", line[:m.start()] + changed + line[m.end():]
    for m in CONDITION.finditer(code):
        if m.group(2).count("(") != m.group(2).count(")"):
            continue
        yield "condition negated", (line[:m.start(2)] + "!(" + line[m.start(2):m.end(2)] + ")" +
                                    line[m.end(2):])
    for m in RETURN.finditer(code):
        value = m.group(1)
        changed = {"true": "false", "false": "true", "0": "1"}.get(value)
        if changed:
            yield f"return {value} to {changed}", line[:m.start(1)] + changed + line[m.end(1):]


def all_changes(folder):
    """(file, line number, what, changed line) of every change of a folder's sources."""
    found = []
    for file in sorted((SOURCE / folder).glob("*.cpp")):
        for number, line in enumerate(file.read_text().splitlines()):
            found += [(file, number, what, changed) for what, changed in changes_of(line)]
    return found


def run(command, timeout=None):
    try:
        return subprocess.run(command, cwd=SOURCE, capture_output=True, timeout=timeout).returncode
    except subprocess.TimeoutExpired:
        return -1


def command_of(entry):
    """The command of a test program with its filter."""
    test, *filters = entry.split()
    program = next(path for path in BUILD.rglob(test) if path.is_file())
    return [program, "--gtest_brief=1", "--gtest_fail_fast=1", *(f"--gtest_filter={f}" for f in filters)]


def build(targets, jobs):
    return run(["cmake", "--build", BUILD, "-j", str(jobs), "--target", *targets]) == 0


def drawn_changes(folder, seed):
    changes = all_changes(folder)
    random.Random(f"{seed} {folder}").shuffle(changes)
    return changes


def check_out():
    commit = subprocess.run(["git", "-C", ROOT, "rev-parse", "HEAD"], check=True,
                            capture_output=True, text=True).stdout.strip()
    if SOURCE.exists():
        subprocess.run(["git", "-C", SOURCE, "checkout", "--quiet", "--force", "--detach", commit],
                       check=True)
    else:
        subprocess.run(["git", "-C", ROOT, "worktree", "add", "--quiet", "--detach", SOURCE, commit],
                       check=True)


def prepare(folders, jobs, count, seed):
    check_out()
    # A few more than are judged: some changes do not compile.
    alone = sorted({str(change[0].relative_to(SOURCE)) for folder in folders
                    for change in drawn_changes(folder, seed)[:count + 4]})
    needs_sessions = any(f.startswith("sessions") or f == "core/record" for f in folders)
    sessions = "ON" if needs_sessions else "OFF"
    if run(["cmake", "-S", SOURCE, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
            "-DBORESIGHT_UNITY=ON", f"-DBORESIGHT_COMPILED_ALONE={';'.join(alone)}",
            "-DBORESIGHT_BUILD_UI=OFF", f"-DBORESIGHT_BUILD_SESSIONS={sessions}"]) != 0:
        sys.exit("mutate.py: cannot configure")
    targets = sorted({t.split()[0] for f in folders for t in TESTS[f]})
    if not build(targets, jobs):
        sys.exit("mutate.py: the unchanged tree does not build")
    limits = {}
    for entry in {e for f in folders for e in TESTS[f]}:
        start = time.monotonic()
        if run(command_of(entry)) != 0:
            sys.exit(f"mutate.py: {entry} fails on the unchanged tree")
        limits[entry] = 60 + 5 * (time.monotonic() - start)
    return limits


def noticed(folder, jobs, limits):
    """The test that notices the change that is in the tree; None: it does not compile; "": none."""
    for entry in TESTS[folder]:
        test = entry.split()[0]
        if not build([test], jobs):
            return None
        if run(command_of(entry), limits[entry]) != 0:
            return test
    return ""


def judge(folder, count, seed, jobs, limits):
    noticed_count = judged = 0
    for file, number, what, changed in drawn_changes(folder, seed):
        if judged == count:
            break
        before = file.read_text()
        lines = before.splitlines(keepends=True)
        ending = "\n" if lines[number].endswith("\n") else ""
        lines[number] = changed + ending
        lines[0] = CHECKS  # in place of the licence, so that lines keep their numbers
        file.write_text("".join(lines))
        test = noticed(folder, jobs, limits)
        file.write_text(before)
        if test is None:
            continue
        judged += 1
        noticed_count += bool(test)
        place = f"{file.relative_to(SOURCE)}:{number + 1}"
        print(f"{'noticed by ' + test if test else 'SURVIVED':32} {place}: {what}", flush=True)
    return noticed_count, judged


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--per-folder", type=int, default=8)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--folder", nargs="+", choices=sorted(TESTS), default=sorted(TESTS))
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    limits = prepare(arguments.folder, arguments.jobs, arguments.per_folder, arguments.seed)
    scores = {}
    for folder in arguments.folder:
        scores[folder] = judge(folder, arguments.per_folder, arguments.seed, arguments.jobs,
                               limits)
    print()
    for name, (hit, all_) in scores.items():
        print(f"{name:24} {hit:4} of {all_:4}  {100 * hit / max(1, all_):5.1f} %")


if __name__ == "__main__":
    main()
