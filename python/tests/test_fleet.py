# SPDX-FileCopyrightText: 2026 the egocal developers
# SPDX-License-Identifier: BSD-3-Clause
"""Many drives on Dask: one machine, and a cluster of two hosts of which one dies."""
import csv
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import egocal

pytest.importorskip("distributed", reason="the Debian package python3-distributed is not installed")
import egocal.fleet  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
PROGRAM = pathlib.Path(os.environ["EGOCAL_BIN_DIR"]) / "egocal"
TRUTH = np.array([0.5, 0.2, -0.3])


@pytest.fixture(scope="module")
def drives(tmp_path_factory):
    """Six short drives of one rig and one of another."""
    folder = tmp_path_factory.mktemp("fleet")
    rows = []
    for seed in range(1, 8):
        subprocess.run([PROGRAM, "simulate", "--out", folder / str(seed), "--poses", "300", "--noise", "0.005", "--terrain",
                        "free", "--seed", str(seed)], check=True, stdout=subprocess.DEVNULL)
        rows.append({"rig": "car" if seed < 7 else "truck", "drive": str(seed), "a": str(folder / str(seed) / "lidar.tum"),
                     "b": str(folder / str(seed) / "camera.tum")})
    return rows


def test_statistics_travel():
    statistics = egocal.Statistics()
    statistics.add(np.eye(4), np.eye(4), 2.0)
    again = pickle.loads(pickle.dumps(statistics))
    assert len(again) == 1 and (again.cost_matrix() == statistics.cost_matrix()).all()


def test_pooled_answers_are_better_than_single_ones(drives):
    rows = [egocal.fleet.solve_drive(drive, {}) for drive in drives]
    pooled = {row["rig"]: row for row in egocal.fleet.pool(rows)}
    car = pooled["car"]
    assert car["drives"] == car["used"] == 6 and car["certified"]
    assert car["pairs"] == sum(row["pairs"] for row in rows[:6])
    error = np.linalg.norm([car[name] for name in "xyz"] - TRUTH)
    single = [np.linalg.norm([row[name] for name in "xyz"] - TRUTH) for row in rows[:6]]
    assert error < np.median(single)
    spread = np.linalg.norm([car[f"stddev_{name}"] for name in "xyz"])
    assert error / 4 < spread < 0.05
    assert "stddev_x" not in pooled["truck"], "the spread of one drive"
    # the answer of one drive alone is that of the drive, to a small part of its standard deviation: 1 cm
    assert np.allclose([pooled["truck"][name] for name in egocal.fleet.POSE], [rows[6][name] for name in egocal.fleet.POSE], atol=5e-4)


def test_a_drive_that_cannot_be_read_is_a_row(drives, tmp_path):
    table = tmp_path / "drives.csv"
    with open(table, "w", newline="") as stream:
        writer = csv.DictWriter(stream, ["rig", "drive", "a", "b", "driver"])
        writer.writeheader()
        writer.writerow(dict(drives[0], driver="Ann, of the \"night\" shift"))
        writer.writerow(dict(drives[1], b=str(tmp_path / "missing.tum")))
    out, rigs = tmp_path / "answers.csv", tmp_path / "rigs.csv"
    assert egocal.fleet.main([str(table), "--out", str(out), "--pooled", str(rigs), "--workers", "1"]) == 0
    answers = list(csv.DictReader(open(out, newline="")))
    assert answers[0]["driver"] == "Ann, of the \"night\" shift" and answers[0]["error"] == "" and answers[0]["certified"] == "True"
    assert "missing.tum" in answers[1]["error"]
    assert list(csv.DictReader(open(rigs, newline="")))[0]["used"] == "1"
    table.write_text("rig,a\ncar,x\n")
    assert egocal.fleet.main([str(table), "--out", str(out)]) == 1


def test_it_runs_as_a_program(drives, tmp_path):
    table, out, rigs = tmp_path / "drives.csv", tmp_path / "answers.csv", tmp_path / "rigs.csv"
    with open(table, "w", newline="") as stream:
        writer = csv.DictWriter(stream, list(drives[0]))
        writer.writeheader()
        writer.writerows(drives[:2])
    run = subprocess.run([sys.executable, "-m", "egocal.fleet", table, "--out", out, "--pooled", rigs, "--workers", "2"],
                         cwd=tmp_path, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    assert [row["error"] for row in csv.DictReader(open(out, newline=""))] == ["", ""]
    assert next(csv.DictReader(open(rigs, newline="")))["used"] == "2"


def test_a_table_that_cannot_be_written_is_refused_before_the_work(tmp_path, capsys):
    def never(*_):
        raise AssertionError("the work began")

    table = tmp_path / "drives.csv"
    table.write_text("a,b\n1,2\n")
    for out, pooled in [(tmp_path / "none" / "out.csv", None), (tmp_path, None), (tmp_path / "out.csv", tmp_path)]:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(egocal.fleet, "solve", never)
            assert egocal.fleet.main([str(table), "--out", str(out), *(["--pooled", str(pooled)] if pooled else [])]) == 1
        assert f"{pooled or out}: cannot be written: " in capsys.readouterr().err
    assert [file.name for file in tmp_path.iterdir()] == ["drives.csv"]


def test_a_table_is_written_whole_or_not_at_all(tmp_path):
    file = tmp_path / "out.csv"
    egocal.fleet.write_table(file, [{"a": 1}])

    class Bad:
        def __str__(self):
            raise OSError(28, "No space left on device")

    with pytest.raises(OSError, match="out.csv: cannot be written: No space"):
        egocal.fleet.write_table(file, [{"a": "x" * 100000}, {"a": Bad()}])
    assert file.read_bytes() == b"a\r\n1\r\n" and [entry.name for entry in tmp_path.iterdir()] == ["out.csv"]
    with pytest.raises(OSError, match="/dev/full: cannot be written: No space"):
        egocal.fleet.write_table("/dev/full", [{"a": 1}])


@pytest.mark.parametrize("workers", [0, -1])
def test_no_worker_is_no_choice(workers):
    with pytest.raises(ValueError, match=f"workers: expected 1 or more, got {workers}"):
        egocal.fleet.solve([{"a": "1", "b": "2"}], workers=workers)


def test_what_is_no_table_is_refused_in_one_line(tmp_path):
    file = tmp_path / "drives.csv"
    for content, why in [(b"a,b\n" + b"x" * 200000 + b",2\n", "field larger"), (b"a,b\n\xff,2\n", "decode"), (b"", "no drive")]:
        file.write_bytes(content)
        with pytest.raises(ValueError, match=f"drives.csv: .*{why}"):
            egocal.fleet.read_table(file)


def test_parquet_is_refused_before_the_work_where_it_cannot_be_written(drives, tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.setattr(egocal.fleet, "solve", lambda *_: pytest.fail("worked before it looked"))
    table = tmp_path / "drives.csv"
    with open(table, "w", newline="") as stream:
        writer = csv.DictWriter(stream, list(drives[0]))
        writer.writeheader()
        writer.writerow(drives[0])
    assert egocal.fleet.main([str(table), "--out", str(tmp_path / "answers.parquet")]) == 1
    assert "use .csv" in capsys.readouterr().err


def cluster_of_two_hosts(drives_file):
    """Run inside two_hosts: a scheduler here, a worker on each host, the second one killed after the first answer."""
    drives = egocal.fleet.read_table(drives_file)
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    python = [sys.executable, "-m"]
    processes = [subprocess.Popen(python + ["distributed.cli.dask_scheduler", "--host", "0.0.0.0", "--port", "8786", "--no-dashboard"], **quiet)]
    workers = {}
    for i in "12":
        enter = ["nsenter", f"--net=/proc/{os.environ['HOST_' + i]}/ns/net"]
        workers[i] = subprocess.Popen(enter + python + ["distributed.cli.dask_worker", f"tcp://10.77.{i}.1:8786", "--nthreads", "1",
                                                        "--no-nanny", "--no-dashboard", "--name", f"host{i}"], **quiet)
        processes.append(workers[i])
    try:
        import distributed
        with distributed.Client("tcp://10.77.1.1:8786", timeout=100) as client:
            client.wait_for_workers(2, timeout=100)
        killed = []

        def kill_one(done, total):
            if done == 2:
                workers["2"].send_signal(signal.SIGKILL)
                workers["2"].wait()
                killed.append(done)

        rows = egocal.fleet.solve(drives * 4, "tcp://10.77.1.1:8786", progress=kill_one)
        assert killed and workers["1"].poll() is None
        for drive, row in zip(drives * 4, rows):
            alone = egocal.fleet.solve_drive(drive, {})
            assert not row["error"] and all(row[name] == alone[name] for name in egocal.fleet.POSE), row
        print("answers:", len(rows))
    finally:
        for process in processes:
            process.kill()
            process.wait()


def test_a_worker_that_dies_costs_nothing(drives, tmp_path):
    table = tmp_path / "drives.csv"
    egocal.fleet.write_table(table, drives)
    begin = time.monotonic()
    done = subprocess.run([HERE.parents[1] / "scripts" / "in-network", HERE / "two_hosts", sys.executable, __file__, table], text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=250)
    assert done.returncode == 0 and "answers: 28" in done.stdout, done.stderr[-3000:]
    print(f"{time.monotonic() - begin:.1f} s")


if __name__ == "__main__":
    cluster_of_two_hosts(sys.argv[1])
