"""Hidden trials in a folder: data, the tested program's verdicts on them, the score.

    DIR/run.json                     what runs here: programs, seeds, ablation
    DIR/KIT/trials/SEED/             what the program gets
    DIR/KIT/truths/SEED.json         what it does not get, sealed by SHA256SUMS
    DIR/KIT/verdicts/SEED/           what it says, and cost.json: seconds of wall and processor
    DIR/KIT/verdicts/SEED.log        what it printed where it failed, and SEED.cost.json

Whatever has a name in there is whole: work in progress stands under a name with a leading dot and is
renamed when it is done. So a run that was killed at any instant goes on when it is started again.
"""

import concurrent.futures
import dataclasses
import fcntl
import hashlib
import json
import os
import pathlib
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
SECONDS_A_TRIAL = 1800.0  # a program that takes longer gives no verdict
NICE = 10


class Refused(Exception):
    """The folder is another run's."""


@dataclasses.dataclass(frozen=True)
class Part:
    """Trials of one kit; seeds as strut_hidden_data reads them."""

    kit: str
    seeds: str


class Build:
    """The programs of a build folder."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.strut = self.folder / "strut"
        self.data = self.folder / "tests/hidden/strut_hidden_data"
        self.score = self.folder / "tests/hidden/strut_hidden_score"
        for program in (self.strut, self.data, self.score):
            if not os.access(program, os.X_OK):
                raise Refused(f"{program}: is missing; build strut and strut_hidden_tests first")


def calc_digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def find_commit():
    """The sources' commit, with a mark where they were changed since; 'unknown' outside of git."""
    try:
        commit = subprocess.run(["git", "rev-parse", "--short=12", "HEAD"], cwd=HERE, check=True,
                                capture_output=True, text=True).stdout.strip()
        changed = subprocess.run(["git", "status", "--porcelain", "--untracked-files=no"], cwd=HERE,
                                 check=True, capture_output=True, text=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return commit + (" with changes" if changed else "")


def write_atomically(path, text):
    begun = path.with_name("." + path.name)
    begun.write_text(text, encoding="utf-8")
    os.replace(begun, path)


class Run:
    """One folder of trials."""

    def __init__(self, build, folder, parts, ablation="none", regime="exact", fresh=False):
        """`fresh`: removes what another run left in the folder."""
        self.build, self.folder, self.parts = build, pathlib.Path(folder), list(parts)
        self.ablation, self.regime = ablation, regime
        self.children, self.guard, self.stopped = set(), threading.RLock(), False
        self.done, self.total, self.began = 0, 0, time.monotonic()
        self.folder.mkdir(parents=True, exist_ok=True)
        self._lock_folder()
        if fresh:
            self._clear_folder()
        self._check_identity()

    def _lock_folder(self):
        self.lock = open(self.folder / ".lock", "w", encoding="utf-8")  # freed when we end
        try:
            fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise Refused(f"{self.folder}: another run works here") from None

    def _clear_folder(self):
        """All but the lock that we hold, of a folder that a run began."""
        if not (self.folder / "run.json").exists():
            return
        # The mark that it is a run's goes last: one that was killed here is cleared again.
        for entry in self.folder.iterdir():
            if entry.is_dir() and not entry.is_symlink():
                shutil.rmtree(entry)
            elif entry.name not in (".lock", "run.json"):
                entry.unlink()
        (self.folder / "run.json").unlink()

    def _check_identity(self):
        """Verdicts of two programs, or trials of two generators, do not mix."""
        identity = {"strut": calc_digest(self.build.strut), "data": calc_digest(self.build.data),
                    "ablation": self.ablation, "regime": self.regime,
                    "parts": [[part.kit, part.seeds] for part in self.parts]}
        path = self.folder / "run.json"
        if path.exists():
            found = json.loads(path.read_text(encoding="utf-8"))
            for key, value in identity.items():
                if found[key] != value:
                    raise Refused(f"{self.folder}: begun with other {key}; take another folder")
            self.commit = found["commit"]
            return
        self.commit = find_commit()
        write_atomically(path, json.dumps({**identity, "commit": self.commit}, indent=1) + "\n")

    # --- data and verdicts ----------------------------------------------------------------------

    def make_data(self, jobs):
        """Raises CalledProcessError where the generator fails."""
        for part in self.parts:
            command = [self.build.data, part.kit, part.seeds, self.folder / part.kit, str(jobs),
                       self.ablation, self.regime]
            child = self._start(command, None)
            _, status = self._wait(child)
            if status != 0:
                raise subprocess.CalledProcessError(status, command)

    def diagnose(self, jobs):
        """Fills in the verdicts that are missing."""
        work = []
        for part in self.parts:
            verdicts = self.folder / part.kit / "verdicts"
            verdicts.mkdir(exist_ok=True)
            for left in verdicts.glob(".*"):
                if left.is_dir():
                    shutil.rmtree(left)
                else:
                    left.unlink()
            trials = sorted((self.folder / part.kit / "trials").iterdir())
            self.total += len(trials)
            missing = [t for t in trials if not (verdicts / t.name / "verdict.json").exists()]
            self.done += len(trials) - len(missing)
            work += [(part, trial) for trial in missing]
        self.first, self.began = self.done, time.monotonic()
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            for future in [pool.submit(self._diagnose_one, *item) for item in work]:
                future.result()

    def _diagnose_one(self, part, trial):
        if self.stopped:
            return
        verdicts = self.folder / part.kit / "verdicts"
        place = pathlib.Path(tempfile.mkdtemp(prefix=f".{trial.name}.", dir=verdicts))
        begin = time.monotonic()
        with open(place / "log", "wb") as log:
            child = self._start([self.build.strut, "diagnose", trial / "campaign.toml", "-o", place,
                                 "--threads", "1", "--force"], log)
            timer = threading.Timer(SECONDS_A_TRIAL, child.kill)
            timer.start()
            usage, status = self._wait(child)
            timer.cancel()
        wall = time.monotonic() - begin
        if self.stopped:
            return
        note = ""
        cost = json.dumps({"wall_s": round(wall, 3),
                           "cpu_s": round(usage.ru_utime + usage.ru_stime, 3)}) + "\n"
        # 1: a verdict, with something that its notes tell.
        if status in (0, 1) and (place / "verdict.json").exists():
            (place / "cost.json").write_text(cost, encoding="utf-8")
            os.replace(place, verdicts / trial.name)
            # Of an attempt before, which failed.
            (verdicts / f"{trial.name}.cost.json").unlink(missing_ok=True)
        else:
            write_atomically(verdicts / f"{trial.name}.cost.json", cost)
            os.replace(place / "log", verdicts / f"{trial.name}.log")
            shutil.rmtree(place)
            note = f", FAILED with status {status}"
        self._tell(part, trial, wall, note)

    def _start(self, command, log):
        with self.guard:
            if self.stopped:
                raise KeyboardInterrupt
            # What is started ends with us, even where we are killed: nobody writes on in the folder.
            prefix = ["setpriv", "--pdeathsig", "KILL", "nice", "-n", str(NICE)]
            child = subprocess.Popen(prefix + [str(word) for word in command], stdout=log,
                                     stderr=log, stdin=subprocess.DEVNULL)
            self.children.add(child)
            return child

    def _wait(self, child):
        """What the child used, and its exit status."""
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        with self.guard:
            self.children.discard(child)
        return usage, child.returncode

    def _tell(self, part, trial, wall, note):
        with self.guard:
            self.done += 1
            spent = time.monotonic() - self.began
            left = spent / (self.done - self.first) * (self.total - self.done)
            print(f"{self.done}/{self.total} {part.kit} {trial.name} {wall:.1f} s{note}, "
                  f"{left / 60:.0f} min to go", file=sys.stderr, flush=True)

    def stop(self):
        """Ends what was started; nothing half done is left under a name."""
        with self.guard:
            self.stopped = True
            for child in self.children:
                child.kill()

    # --- what came out --------------------------------------------------------------------------

    def score(self, *options):
        """Exit status and text of the scorer."""
        command = [self.build.score, *options]
        for part in self.parts:
            command += [self.folder / part.kit / "truths", self.folder / part.kit / "verdicts"]
        outcome = subprocess.run([str(word) for word in command], capture_output=True, text=True,
                                 check=False)
        if outcome.returncode not in (0, 1):
            raise RuntimeError(outcome.stderr.strip())
        return outcome.returncode, outcome.stdout

    def make_provenance(self):
        """Markdown: the commit, the seeds with the truths' digests, the cost of a trial, also of
        those that failed or took too long."""
        lines = [f"Commit {self.commit}; each diagnosis with one thread.", "",
                 "| kit | seeds | SHA-256 of truths/SHA256SUMS | wall s: median, 90 %, most | "
                 "processor s: median, most |", "|---|---|---|---|---|"]
        for part in self.parts:
            folder = self.folder / part.kit
            costs = [json.loads(path.read_text(encoding="utf-8"))
                     for pattern in ("verdicts/*/cost.json", "verdicts/*.cost.json")
                     for path in sorted(folder.glob(pattern))]
            wall = sorted(cost["wall_s"] for cost in costs) or [0.0]
            cpu = sorted(cost["cpu_s"] for cost in costs) or [0.0]
            ninth = wall[min(len(wall) - 1, int(0.9 * len(wall)))]
            lines.append(f"| {part.kit} | {part.seeds} | {calc_digest(folder / 'truths/SHA256SUMS')}"
                         f" | {statistics.median(wall):.1f}, {ninth:.1f}, {wall[-1]:.1f} | "
                         f"{statistics.median(cpu):.1f}, {cpu[-1]:.1f} |")
        return "\n".join(lines) + "\n"


def run_all(run, jobs):
    """Data and verdicts."""
    def interrupt(number, _):
        run.stop()
        raise SystemExit(128 + number)

    signal.signal(signal.SIGTERM, interrupt)
    signal.signal(signal.SIGINT, interrupt)
    run.make_data(jobs)
    run.diagnose(jobs)


def main_of(run_command):
    """Runs a command of this folder; its exit status."""
    try:
        return run_command()
    except Refused as refusal:
        print(refusal, file=sys.stderr)
        return 2
    except (tomllib.TOMLDecodeError, json.JSONDecodeError, TypeError, KeyError) as mistake:
        # A file that is none: 1 would say that a limit is missed.
        print(f"{type(mistake).__name__}: {mistake}", file=sys.stderr)
        return 2
    except (OSError, RuntimeError, subprocess.CalledProcessError) as failure:
        print(failure, file=sys.stderr)
        return 3
