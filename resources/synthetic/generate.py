#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders data sets with Blender: true poses exact, seeds as an arm or a hand has them.

    python3 resources/synthetic/generate.py --out DIR --cases 60 --seed 1 --jobs 2

What is finished is never made again: the same command goes on after an interruption, and with a
larger --cases it extends the set. Needs `blender` (3.4 or later) and nothing else.
"""

import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

sys.dont_write_bytecode = True
HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import layout
import plan

FORMAT = {"format": "boresight-synthetic", "version": 2}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    add = parser.add_argument
    add("--out", required=True, type=Path, metavar="DIR", help="where the data set goes")
    add("--cases", required=True, type=int, metavar="N", help="cases for each station")
    add("--seed", type=int, default=1, metavar="S", help="of everything that is drawn")
    add("--jobs", type=int, default=1, metavar="J", help="pictures made at once")
    add("--stations", default="bc,os", help=f"of {', '.join(plan.STATIONS)} (default bc,os)")
    add("--pairs", type=float, default=0.25, metavar="SHARE",
        help="share of shots taken by both cameras at once (default 0.25)")
    for name, text in (("far", "far standoff, 1.05 to 1.30 m"), ("hard", "hard cases")):
        add("--" + name, type=float, nargs="?", const=1.0, default=0.0, metavar="SHARE",
            help=f"share of shots with {text} (without a number: all)")
    add("--state", action="store_true",
        help="a lid and a gripper in half of the pictures; needs --pairs 0")
    add("--sun-behind", action="store_true", help="the sun behind the camera; not with --hard")
    add("--seeds", type=int, default=1, metavar="N",
        help="seeds of each picture; a further one is a case ID-s001, ... (default 1)")
    add("--size", type=int, default=plan.SIDE_px, metavar="PX",
        help="side of the pictures; the view stays the same (default 2048)")
    add("--blender", default="blender", help="the program")
    options = parser.parse_args()
    options.stations = options.stations.split(",")
    if min(options.cases, options.jobs, options.seeds) < 1 or options.size < 64:
        parser.error("--cases, --jobs and --seeds must be at least 1, --size at least 64")
    if options.state and (options.pairs > 0.0 or not set(options.stations) <= {"bc", "os"}):
        parser.error("--state is of bc and os, with --pairs 0")
    if options.sun_behind and options.hard > 0.0:
        parser.error("--sun-behind is not for --hard, which shadows")
    if not set(options.stations) <= set(plan.STATIONS):
        parser.error("--stations knows " + ", ".join(plan.STATIONS))
    return options


def claim(options):
    """Refuses to mix two sets in one folder, and clears what a killed run left."""
    drawn = {k: getattr(options, k) for k in ("seed", "pairs", "far", "hard", "size")}
    for name in ("state", "sun_behind"):
        if getattr(options, name):
            drawn[name] = True
    file = options.out / "generator.json"
    if file.exists():
        known = json.loads(file.read_text())
        if {k: known.pop(k, None) for k in FORMAT} != FORMAT:
            raise SystemExit(f"{file}: another version of the generator made this set; give another "
                             "folder")
        if known != drawn:
            raise SystemExit(f"{file}: the folder holds a set made with {known}; give the same "
                             "options or another folder")
    elif options.out.exists() and any(options.out.iterdir()):
        raise SystemExit(f"{options.out}: is not empty and holds no generated set; give another "
                         "folder")
    layout.replace_json(file, {**FORMAT, **drawn})
    shutil.rmtree(options.out / "unfinished", ignore_errors=True)
    (options.out / "unfinished").mkdir()


def start(options, log, *words):
    """Blender on one script; its chatter goes to a file that is kept when it fails."""
    threads = max(1, (os.cpu_count() or 1) // options.jobs)
    command = [options.blender, "-b", "--factory-startup", "-t", str(threads),
               "--python-exit-code", "1", "--python", str(HERE / "render_shot.py"), "--", *words]
    with open(log, "w") as file:
        return subprocess.Popen(command, stdout=file, stderr=subprocess.STDOUT,
                                env=environment(options.blender))


def environment(blender):
    """Puts Blender's folder first in PATH: Debian's Blender takes the first python3 there."""
    made = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
    folder = str(Path(shutil.which(blender)).resolve().parent)
    return {**made, "PATH": folder + os.pathsep + made.get("PATH", "")}


def make_meshes(options):
    if all((options.out / s / "parts.json").exists() for s in plan.STATIONS):
        return
    log = options.out / "unfinished" / "meshes.log"
    if start(options, log, "meshes", str(options.out)).wait() != 0:
        raise SystemExit(f"blender could not make the meshes; what it said is in {log}")


def unfinished_shots(options):
    """The plans that lack pictures, the stations in turn so that an early stop has both."""
    plans = [plan.shots(options.seed, station, options.cases, options.pairs, options.far,
                        options.hard, options.size, options.state, options.sun_behind)
             for station in options.stations]
    longest = max(len(p) for p in plans)
    turn = [p[i] for i in range(longest) for p in plans if i < len(p)]
    done = {p.stem for p in (options.out / "cases").glob("*.json")}
    return [p for p in turn if not all(f["id"] in done for f in p["frames"])]


class Run:
    """Keeps up to --jobs Blenders at work."""

    def __init__(self, options, todo):
        self.options, self.todo, self.running, self.failed = options, todo, {}, []
        self.total = sum(len(p["frames"]) for p in todo)
        self.made, self.started = 0, time.monotonic()

    def go(self):
        while self.todo or self.running:
            while self.todo and len(self.running) < self.options.jobs:
                self._begin(self.todo.pop(0))
            time.sleep(0.2)
            for process in [p for p in self.running if p.poll() is not None]:
                self._end(process, *self.running.pop(process))

    def stop(self):
        for process in self.running:
            process.terminate()
        for process in self.running:
            process.wait()

    def _begin(self, shot):
        file = self.options.out / "unfinished" / f"{shot['shot']}.json"
        file.write_text(json.dumps(shot))
        log = file.with_suffix(".log")
        process = start(self.options, log, "shot", str(file), str(self.options.out))
        self.running[process] = (shot, log)

    def _end(self, process, shot, log):
        self.made += len(shot["frames"])
        if process.returncode == 0:
            log.unlink()
        else:
            self.failed.append(log)
            print(f"{shot['shot']} failed; what blender said is in {log}", file=sys.stderr)
        layout.write(self.options.out, self.options.seeds)
        rate = self.made / (time.monotonic() - self.started)
        left_min = (self.total - self.made) / rate / 60.0
        if sys.stderr.isatty():
            print(f"{self.made} of {self.total} pictures, {3600.0 * rate:.0f} an hour, "
                  f"{left_min:.0f} min left", file=sys.stderr)


def interrupted(*_):
    raise KeyboardInterrupt


def main():
    options = arguments()
    if shutil.which(options.blender) is None:
        raise SystemExit(f"{options.blender}: no such program; install Debian's package blender")
    signal.signal(signal.SIGTERM, interrupted)
    options.out.mkdir(parents=True, exist_ok=True)
    claim(options)
    make_meshes(options)
    run = Run(options, unfinished_shots(options))
    try:
        run.go()
    except KeyboardInterrupt:
        run.stop()
        raise SystemExit("stopped; the same command goes on")
    count = layout.write(options.out, options.seeds)
    print(f"{count} pictures in {options.out / 'dataset.json'}")
    if run.failed:
        raise SystemExit(f"{len(run.failed)} shots failed; the same command tries them again")
    shutil.rmtree(options.out / "unfinished")


if __name__ == "__main__":
    main()
