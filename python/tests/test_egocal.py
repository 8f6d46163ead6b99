# SPDX-FileCopyrightText: 2026 the egocal developers
# SPDX-License-Identifier: BSD-3-Clause
import copy
import inspect
import json
import os
import pathlib
import pickle
import subprocess
import warnings

import numpy as np
import pytest

import egocal

PROGRAM = pathlib.Path(os.environ["EGOCAL_BIN_DIR"]) / "egocal"


@pytest.fixture(scope="module")
def drive(tmp_path_factory):
    """Two TUM files of one simulated drive."""
    folder = tmp_path_factory.mktemp("drive")
    subprocess.run([PROGRAM, "simulate", "--out", folder, "--poses", "400", "--noise", "0.01"], check=True,
                   stdout=subprocess.DEVNULL)
    return sorted(folder.glob("*.tum"))


def command_line(*arguments):
    """What `egocal solve` prints; exit code 3 says that the answer should not be used."""
    done = subprocess.run([PROGRAM, "solve", *arguments, "--json"], stdout=subprocess.PIPE)
    assert done.returncode in (0, 3)
    return json.loads(done.stdout)


def matrices(rows):
    T = np.tile(np.eye(4), (len(rows), 1, 1))
    for i, (x, y, z, w) in enumerate(rows[:, 4:8]):
        T[i, :3, :3] = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
        T[i, :3, 3] = rows[i, 1:4]
    return T


@pytest.mark.parametrize("options, flags", [({}, []), ({"weights": "equal"}, ["--weights", "equal"]),
                                            ({"stride": 3, "weights": (1, 0.1)}, ["--stride", "3", "--weights", "1:0.1"])])
def test_files_give_the_bits_of_the_command_line(drive, options, flags):
    calibration = egocal.solve(str(drive[0]), drive[1], **options)
    expected = command_line(*drive, *flags)
    ours = json.loads(calibration.to_json())
    for key in ours:
        if key != "weights":
            assert ours[key] == expected[key], key
    assert calibration.certified
    assert np.allclose(calibration.T_a_b @ calibration.T_b_a, np.eye(4), atol=1e-12)


def test_arrays_and_matrices_give_the_answer_of_the_files(drive):
    from_files = egocal.solve(*map(str, drive))
    a, b = (np.loadtxt(file) for file in drive)
    from_rows = egocal.solve(a, b)
    assert np.allclose(from_rows.T_a_b, from_files.T_a_b, atol=1e-6)
    from_matrices = egocal.solve((a[:, 0], matrices(a)), (b[:, 0], matrices(b)))
    assert np.allclose(from_matrices.T_a_b, from_files.T_a_b, atol=1e-6)
    shuffled = egocal.solve(np.random.default_rng(1).permutation(a), b)
    assert (shuffled.T_a_b == from_rows.T_a_b).all()


def test_bad_arguments_are_named(drive):
    rows = np.loadtxt(drive[0])
    with pytest.raises(ValueError, match="a: expected an .N, 8. array"):
        egocal.solve(rows[:, :7], rows)
    broken = rows.copy()
    broken[7, 4:] = np.nan
    with pytest.raises(ValueError, match="b: row 7"):
        egocal.solve(rows, broken)
    with pytest.raises(ValueError, match="weights"):
        egocal.solve(rows, rows, weights="heavy")
    with pytest.raises(egocal.Error, match="missing.tum"):
        egocal.solve("/nonexistent/missing.tum", rows)
    with pytest.raises(egocal.Error, match="no motion pairs"):
        egocal.solve(rows, rows + np.array([1e6, 0, 0, 0, 0, 0, 0, 0]))


def changed(rows, row, column, value):
    copy = rows.copy()
    copy[row, column] = value
    return copy


def test_what_is_no_trajectory_is_refused_with_its_reason(drive):
    rows = np.loadtxt(drive[0])
    masked = np.ma.masked_array(rows, mask=False)
    masked[5, 1] = np.ma.masked
    for bad, why in [
        (changed(rows, 5, 2, np.inf), "a: row 5: not a pose: position: expected finite numbers"),
        (changed(rows, 5, 1, 1e300), "a: row 5: not a pose: position: expected less than 1e9 m"),
        (changed(rows, 5, 6, np.nan), "a: row 5: not a pose: quaternion: expected finite numbers"),
        (changed(rows, 5, 7, 2.0), "a: row 5: not a pose: quaternion: expected length 1, got [12]"),
        (changed(rows, 5, slice(4, 8), 0), "a: row 5: not a pose: quaternion: is zero"),
        (changed(rows, 5, 0, 1.7e18), "a: row 5: expected a time in seconds, got 1.7e.18"),
        (rows.astype(np.float32), "a: its times are .* s apart in float32: give them as float64"),
        (masked, "a: has masked entries"),
        (rows.astype(complex), "a: expected real numbers"),
        ({}, "a: expected a file name, an .N, 8. array"),
        (b"lidar.tum", "a: expected a file name"),
        ([rows[:, 0], matrices(rows)], "a: expected a file name"),
        ("", "a: the file name is empty"),
    ]:
        with pytest.raises(ValueError, match=why):
            egocal.solve(bad, rows)
    relative = rows - np.array([rows[0, 0], 0, 0, 0, 0, 0, 0, 0])
    assert egocal.solve(relative.astype(np.float32), relative).pairs > 0  # fine enough


def test_file_names_are_those_of_the_file_system(drive):
    class Named:
        def __init__(self, name):
            self.name = name

        def __fspath__(self):
            return self.name

    expected = egocal.solve(*drive).T_a_b
    with os.scandir(pathlib.Path(drive[0]).parent) as entries:
        entry = [entry for entry in entries if entry.path == str(drive[0])][0]
    for name in (entry, Named(str(drive[0])), Named(os.fsencode(drive[0]))):
        assert (egocal.solve(name, drive[1]).T_a_b == expected).all()
    with pytest.raises(ValueError, match=r"a: the file name is not in UTF-8: '/nowhere/.udcff'"):
        egocal.solve("/nowhere/\udcff", drive[1])
    with pytest.raises(ValueError, match="b: the file name has a null character"):
        egocal.solve(drive[0], str(drive[1]) + "\0x")


def test_options_that_cannot_be_understood_are_value_errors(drive):
    rows = np.loadtxt(drive[0])
    for option, value in [("weights", (1, 1, 1)), ("weights", None), ("time_offset", None), ("nominal", np.eye(3)),
                          ("nominal", 2 * np.eye(4)), ("plane_a", "flat"), ("plane_a", (0, 0, 1))]:
        with pytest.raises(ValueError, match=option):
            egocal.solve(rows, rows, **{option: value})
    with pytest.raises(egocal.Error, match="translation weight: expected 1e-12 to 1e.12, got 1e-300"):
        egocal.solve(rows, rows, weights=(1e-300, 1e-300))


def test_values_of_a_wrong_type_are_named_in_one_line(drive):
    """pybind11 printed all of the signature and the arrays, in several lines."""
    rows = np.loadtxt(drive[0])
    turns, places = [np.array([0.1 * i, 0.2, 0.3]) for i in range(5)], [np.ones(3)] * 5
    statistics = egocal.Statistics()

    def hand_eye(place, value):
        lists = [turns, places, turns, places]
        lists[place] = value
        return egocal.calibrate_hand_eye(*lists)

    wrong = [None, 5, 0.5, iter(turns), {1: 2}, np.array(3.0)]
    calls = [(name, lambda place=place, value=value: hand_eye(place, value)) for value in wrong
             for place, name in enumerate(["R_gripper2base", "t_gripper2base", "R_target2cam", "t_target2cam"])]
    calls.append(("details", lambda: egocal.calibrate_hand_eye(turns, places, turns, places, details="yes")))
    for name, values in [("method", [None, 5]), ("stride", [1.5, "auto", 10**30]), ("max_gap", [None, "long"]),
                         ("time_offset", [[1, 2]])]:
        calls += [(name, lambda name=name, value=value: egocal.solve(rows, rows, **{name: value})) for value in values]
    for value in (None, "much", [1]):
        calls += [("weight", lambda value=value: statistics.add(np.eye(4), np.eye(4), value)),
                  ("rotation", lambda value=value: statistics.cost_matrix(value)),
                  ("translation", lambda value=value: statistics.cost_matrix(1, value))]
    for name, call in calls:
        with pytest.raises(ValueError, match=f"^{name}: expected [^\\n]*, got [^\\n]*$"):
            call()
    with pytest.raises(ValueError, match="t_target2cam: expected a sequence of translations of 3 numbers, got None"):
        hand_eye(3, None)
    with pytest.raises(TypeError, match="unsupported operand"):
        statistics + 1
    with pytest.raises(TypeError, match="unsupported operand"):
        statistics += None


def test_functions_are_functions_of_python(drive):
    """Those of pybind11 cannot be pickled, and answer a misspelt name by their signature and all arrays."""
    for function in (egocal.solve, egocal.calibrate_hand_eye, egocal.solve_dual, egocal.verify):
        assert pickle.loads(pickle.dumps(function)) is function
        assert function.__doc__.strip() and not function.__doc__.startswith(function.__name__ + "(")
    rows = np.loadtxt(drive[0])
    for call in (lambda: egocal.solve(rows), lambda: egocal.solve(rows, rows, "global"), lambda: egocal.solve(rows, rows, methd="fast"),
                 lambda: egocal.calibrate_hand_eye([], []), lambda: egocal.solve_dual(), lambda: egocal.verify(Q=rows)):
        with pytest.raises(TypeError, match=r"^(solve|calibrate_hand_eye|solve_dual|verify)\(\) [^\n]*$"):
            call()
    native = egocal._egocal.solve.__doc__.partition("\n")[0]
    for name, parameter in inspect.signature(egocal.solve).parameters.items():
        if parameter.default is not parameter.empty:
            assert f"{name}: object = {parameter.default!r}" in native


def test_no_number_that_is_none_reaches_the_statistics():
    statistics, nan = egocal.Statistics(), float("nan")
    for weight in (-1, nan, float("inf")):
        with pytest.raises(ValueError, match="weight: expected a finite number"):
            statistics.add(np.eye(4), np.eye(4), weight)
    assert len(statistics) == 0
    with pytest.raises(ValueError, match="translation"):
        statistics.cost_matrix(1, nan)
    for Q in (np.full((8, 8), nan), np.arange(64.0).reshape(8, 8)):
        with pytest.raises(ValueError, match="Q: expected"):
            egocal.solve_dual(Q)
        with pytest.raises(ValueError, match="Q: expected"):
            egocal.verify(Q, np.eye(4))
    far = np.eye(4)
    far[0, 3] = 1e200
    with pytest.raises(ValueError, match="motion_a: not a rigid displacement"):
        statistics.add(far, np.eye(4))
    # what lies under a mask, and the real part of a complex number, were taken without a word
    for make, why in [(lambda M: np.ma.masked_array(M, mask=np.eye(len(M), dtype=bool)), "has masked entries"),
                      (lambda M: M * (1 + 2j), "expected real numbers")]:
        for name, call in [("motion_a", lambda: statistics.add(make(np.eye(4)), np.eye(4))),
                           ("motion_b", lambda: statistics.add(np.eye(4), make(np.eye(4)))),
                           ("Q", lambda: egocal.solve_dual(make(np.eye(8)))),
                           ("Q", lambda: egocal.verify(make(np.eye(8)), np.eye(4))),
                           ("T_a_b", lambda: egocal.verify(np.eye(8), make(np.eye(4))))]:
            with pytest.raises(ValueError, match=f"{name}: {why}"):
                call()
    assert len(statistics) == 0
    with pytest.raises(ValueError, match="Q: expected an .8, 8. matrix"):
        egocal.solve_dual(np.zeros((8, 7)))
    statistics.add(np.eye(4).tolist(), np.eye(4, dtype=int))
    assert len(statistics) == 1


def test_reading_files_releases_the_lock(drive):
    """Another thread writes what is read."""
    import threading
    folder = pathlib.Path(drive[0]).parent
    pipes = [folder / "a.pipe", folder / "b.pipe"]
    for pipe in pipes:
        os.mkfifo(pipe)

    def write():
        for pipe, file in zip(pipes, drive):
            pipe.write_bytes(pathlib.Path(file).read_bytes())

    writer = threading.Thread(target=write, daemon=True)
    writer.start()
    answer = egocal.solve(*pipes)  # hangs where it keeps the lock
    writer.join()
    assert (answer.T_a_b == egocal.solve(*drive).T_a_b).all()


def random_pose(rng, turn=0.5):
    axis = rng.normal(size=3)
    axis *= turn * rng.uniform(0.3, 1) / np.linalg.norm(axis)
    angle = np.linalg.norm(axis)
    K = np.cross(np.eye(3), axis / angle)
    T = np.eye(4)
    T[:3, :3] = np.eye(3) - np.sin(angle) * K + (1 - np.cos(angle)) * K @ K
    T[:3, 3] = rng.normal(size=3)
    return T


def test_statistics_solve_and_proof():
    rng = np.random.default_rng(2)
    X = random_pose(rng)
    whole, parts = egocal.Statistics(), [egocal.Statistics(), egocal.Statistics()]
    for i in range(20):
        A = random_pose(rng)
        B = np.linalg.inv(X) @ A @ X
        whole.add(A, B)
        parts[i % 2].add(A, B)
    assert len(whole) == 20 and len(parts[0] + parts[1]) == 20
    Q = whole.cost_matrix()
    assert np.allclose(egocal.solve_dual(Q), X, atol=1e-9)
    assert np.allclose((parts[0] + parts[1]).cost_matrix(), Q)
    assert egocal.verify(Q, X)["certified"]
    X[0, 3] += 0.1
    assert not egocal.verify(Q, X)["certified"]


@pytest.mark.parametrize("n", [3, 5, 20])
def test_hand_eye_has_opencvs_signature(n):
    rng = np.random.default_rng(n)
    X, target = random_pose(rng), random_pose(rng)
    gripper = [random_pose(rng, 1.5) for _ in range(n)]
    seen = [np.linalg.inv(G @ X) @ target for G in gripper]
    R, t, details = egocal.calibrate_hand_eye([G[:3, :3] for G in gripper], [G[:3, 3] for G in gripper],
                                              [S[:3, :3] for S in seen], [S[:3, 3:] for S in seen], details=True)
    assert details["certified"] and details["all_observable"]
    assert np.allclose(R, X[:3, :3], atol=1e-9) and np.allclose(t, X[:3, 3], atol=1e-9)


def test_hand_eye_takes_one_array_of_all_poses_as_well():
    rng = np.random.default_rng(3)
    X, target = random_pose(rng), random_pose(rng)
    gripper = np.array([random_pose(rng) for _ in range(7)])
    seen = np.linalg.inv(gripper @ X) @ target
    lists = [list(gripper[:, :3, :3]), list(gripper[:, :3, 3]), list(seen[:, :3, :3]), list(seen[:, :3, 3])]
    arrays = [gripper[:, :3, :3], gripper[:, :3, 3:], seen[:, :3, :3], seen[:, :3, 3]]  # (7, 3, 1) and (7, 3)
    for by_lists, by_arrays in zip(egocal.calibrate_hand_eye(*lists), egocal.calibrate_hand_eye(*arrays)):
        assert np.array_equal(by_lists, by_arrays)
    with pytest.raises(ValueError, match="target2cam 0: expected a 3 x 3"):
        egocal.calibrate_hand_eye(arrays[0], arrays[1], seen[:, :2, :3], arrays[3])


def test_hand_eye_finds_the_wrong_pose_and_the_target():
    rng = np.random.default_rng(11)
    X, target = random_pose(rng), random_pose(rng)
    gripper = [random_pose(rng) for _ in range(10)]
    seen = [np.linalg.inv(G @ X) @ target for G in gripper]
    seen[3] = seen[3] @ random_pose(rng)
    poses = ([G[:3, :3] for G in gripper], [G[:3, 3] for G in gripper], [S[:3, :3] for S in seen],
             [S[:3, 3] for S in seen])
    with pytest.warns(egocal.EgocalWarning, match="1 of 10 poses contradict the others and do not count: 3 .the first"):
        egocal.calibrate_hand_eye(*poses)
    with pytest.warns(egocal.EgocalWarning, match="do not count"):
        R, t, details = egocal.calibrate_hand_eye(*poses, details=True)
    assert "wrong_samples" in [finding["code"] for finding in details["findings"]]
    assert details["wrong"] == [3] and details["spread"] < 1e-9
    assert np.allclose(R, X[:3, :3], atol=1e-9) and np.allclose(t, X[:3, 3], atol=1e-9)
    assert np.allclose(details["R_target2base"], target[:3, :3], atol=1e-9)
    assert np.allclose(details["t_target2base"], target[:3, 3], atol=1e-9)


def test_hand_eye_names_the_pose_that_is_none():
    turns, places = [np.array([0.1 * i, 0.2, 0.3]) for i in range(5)], [np.ones(3)] * 5
    far = places[:3] + [np.full(3, 1e200)] + places[4:]
    with pytest.raises(ValueError, match="gripper2base 3: not a rigid displacement"):
        egocal.calibrate_hand_eye(turns, far, turns, places)
    huge = turns[:2] + [np.full(3, 1e300)] + turns[3:]
    with pytest.raises(ValueError, match="target2cam 2: expected a rotation vector of finite numbers, less than 1e6"):
        egocal.calibrate_hand_eye(turns, places, huge, places)


def test_messages_name_arguments_instead_of_options(drive):
    a, b = (np.loadtxt(file, comments="#") for file in drive)
    b[:, 0] += 3600
    with pytest.raises(egocal.Error, match="time_offset='auto'") as failure:
        egocal.solve(a, b)
    assert "--" not in str(failure.value)


def test_hand_eye_never_hides_what_it_cannot_know():
    """Poses that all turn about one axis leave a direction open; the answer is finite and says so."""
    rng = np.random.default_rng(5)
    X, target = random_pose(rng), random_pose(rng)
    gripper = []
    for angle in np.linspace(0, 1, 8):
        G = np.eye(4)
        G[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        G[:3, 3] = rng.normal(size=3)
        gripper.append(G)
    seen = [np.linalg.inv(G @ X) @ target for G in gripper]
    R, t, details = egocal.calibrate_hand_eye([G[:3, :3] for G in gripper], [G[:3, 3] for G in gripper],
                                              [S[:3, :3] for S in seen], [S[:3, 3] for S in seen], details=True)
    assert np.isfinite(R).all() and np.isfinite(t).all()
    assert not details["all_observable"]
    # no motion at all
    same = [np.eye(4)] * 4
    R, t, details = egocal.calibrate_hand_eye([S[:3, :3] for S in same], [S[:3, 3] for S in same],
                                              [S[:3, :3] for S in same], [S[:3, 3] for S in same], details=True)
    assert np.isfinite(R).all() and not any(details["observable"])
    with pytest.raises(ValueError, match="three poses"):
        egocal.calibrate_hand_eye([np.eye(3)] * 2, [np.zeros(3)] * 2, [np.eye(3)] * 2, [np.zeros(3)] * 2)
    with pytest.raises(ValueError, match="gripper2base 1"):
        egocal.calibrate_hand_eye([np.eye(3), np.full((3, 3), np.nan), np.eye(3)], [np.zeros(3)] * 3,
                                  [np.eye(3)] * 3, [np.zeros(3)] * 3)


@pytest.fixture(scope="module")
def flat(tmp_path_factory):
    """On flat ground nothing shows the height, which is y in the camera."""
    folder = tmp_path_factory.mktemp("flat")
    subprocess.run([PROGRAM, "simulate", "--out", folder, "--poses", "400", "--noise", "0.01", "--terrain", "flat"],
                   check=True, stdout=subprocess.DEVNULL)
    return sorted(folder.glob("*.tum"))


def test_an_answer_that_is_not_good_warns(drive, flat):
    with pytest.warns(egocal.EgocalWarning, match="^incomplete: Not known to .* y[.]") as caught:
        calibration = egocal.solve(*flat)
    assert caught[0].filename == __file__
    assert not calibration.observable[1] and calibration.verdict == "incomplete"
    assert repr(calibration).startswith("<egocal.Calibration incomplete: translation [")
    assert ", unknown, " in repr(calibration)
    with warnings.catch_warnings():
        warnings.simplefilter("error", egocal.EgocalWarning)
        assert repr(egocal.solve(*drive)).startswith("<egocal.Calibration good: ")
        with pytest.raises(egocal.EgocalWarning):
            egocal.solve(*flat)
    for text in (calibration.to_json(), str(list(calibration.to_dict()))):
        assert text.index("verdict") < text.index("reason") < text.index("certified")
    assert calibration.to_dict()["reason"] == calibration.reason


def test_hand_eye_warns_without_details():
    same = [np.eye(3)] * 4, [np.zeros(3)] * 4
    with pytest.warns(egocal.EgocalWarning, match="^incomplete: "):
        egocal.calibrate_hand_eye(*same, *same)


def test_an_identity_that_nothing_was_found_for_warns():
    with pytest.warns(egocal.EgocalWarning, match="solve_dual: degenerate"):
        egocal.solve_dual(np.zeros((8, 8)))
    rng, statistics = np.random.default_rng(1), egocal.Statistics()
    X = random_pose(rng)
    for _ in range(10):
        A = random_pose(rng)
        statistics.add(A, np.linalg.inv(X) @ A @ X)
    with pytest.warns(egocal.EgocalWarning, match="solve_dual: Q shows no translation"):
        egocal.solve_dual(statistics.cost_matrix(1, 0))
    with warnings.catch_warnings():
        warnings.simplefilter("error", egocal.EgocalWarning)
        egocal.solve_dual(statistics.cost_matrix(1, 1e-6))


def test_findings_are_those_of_the_command_line(drive):
    """Inverse poses, and a nominal value that a good drive does not need but contradicts."""
    with pytest.warns(egocal.EgocalWarning, match="^contradictory: "):
        found = egocal.solve(*mixed_up(drive))
    first = found.findings[0]
    assert first["certain"] and first["improvement"] > 7 and len(first["translation"]) == 3
    assert set(first) >= {"code", "certain", "message", "remedy", "improvement", "rotation_wxyz"}
    assert found.to_dict()["findings"] == found.findings == json.loads(found.to_json())["findings"]
    assert pickle.loads(pickle.dumps(found)).findings == found.findings
    assert egocal.solve(*drive).findings == command_line(*drive)["findings"]
    far = np.eye(4)
    far[:3, 3] = 20, 30, 40
    with pytest.warns(egocal.EgocalWarning, match="good, but: The nominal value is .* from what the motions show"):
        assert [finding["code"] for finding in egocal.solve(*drive, nominal=far).findings] == ["nominal"]


def mixed_up(drive):
    """The drive with inverse poses of b."""
    rows = np.loadtxt(drive[1])
    poses = np.linalg.inv(matrices(rows))
    return drive[0], (rows[:, 0], poses)


def test_what_was_lost_while_reading_is_reported(drive, tmp_path):
    cut = tmp_path / "cut.tum"
    cut.write_bytes(pathlib.Path(drive[1]).read_bytes()[:-20])
    with pytest.warns(egocal.EgocalWarning, match="cut.tum: "):
        calibration = egocal.solve(drive[0], cut)
    assert len(calibration.notes) == 1 and calibration.notes[0].startswith(f"{cut}: ")
    assert calibration.notes == command_line(drive[0], cut)["notes"] == calibration.to_dict()["notes"]
    rows = np.loadtxt(drive[0])
    with pytest.warns(egocal.EgocalWarning, match="b: 1 pose with the time of another one"):
        assert len(egocal.solve(drive[1], np.vstack([rows, rows[-1:]])).notes) == 1
    assert egocal.solve(*drive).notes == []


def test_a_calibration_travels(flat):
    with pytest.warns(egocal.EgocalWarning):
        calibration = egocal.solve(*flat)
    for other in (pickle.loads(pickle.dumps(calibration)), copy.deepcopy(calibration)):
        assert other.to_json() == calibration.to_json() and repr(other) == repr(calibration)
        assert (other.T_a_b == calibration.T_a_b).all() and (other.T_b_a == calibration.T_b_a).all()
        assert (other.statistics.cost_matrix() == calibration.statistics.cost_matrix()).all()
