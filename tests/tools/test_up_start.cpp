// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What `egocal up` looks at before it starts anything, and what it refuses.
#include <map>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/bus/loop.hpp"
#include "up.hpp"

namespace egocal::test_up_start {
namespace {

using namespace std::chrono_literals;
using test::ChildProcess;
using test::lines;
using test::read;
using test::until;
using test::Up;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(Up, SaysInOneLineWhatIsWrong) {
  const auto refused = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {paths::bin_dir() + "/egocal", "up"});
    std::filesystem::remove(path("said"));
    EXPECT_EQ(ChildProcess(arguments, path("said")).wait(30s), 1);
    EXPECT_EQ(lines(path("said")).size(), 1u) << read(path("said"));
  };
  refused({rig, "--lcm-url", "udpm://nowhere:1"});
  refused({rig, "--log", path("none.log")});
  refused({path("none.toml")});
  refused({rig, "--output-dir", rig + "/in"});
  refused({rig, "--state", "/nonexistent/x"});
  refused({rig, "--state", path("")});
  // pairing and the diagnosis were started again and again, without an end
  std::ofstream(path("part.toml")) << read(rig) << "nominal = [nan, nan, 1.0]\n";
  refused({path("part.toml"), "--log", log});
  EXPECT_THAT(read(path("said")), HasSubstr("part.toml: pair \"lidar\", \"camera\": nominal: a part of it"));
}

// Each of them was tried again and again, without an end.
TEST_F(Up, RefusesAStateThatCanNeverBeOne) {
  std::filesystem::copy_file(rig, path("text"));
  std::filesystem::create_symlink("loop", path("loop"));
  std::filesystem::create_directory(path("a.lock"));
  std::filesystem::copy_file(rig, path("b.diagnosis"));
  std::ofstream(path("c")) << "egocal-diagnosis state 4l\n";
  const std::map<std::string, std::string> why{{"text", "text: is not a state of egocal-pairing"},
                                               {"loop", "loop: cannot be read"},
                                               {"a", "a.lock: is there and is not a file"},
                                               {"b", "b.diagnosis: is not a state of egocal-diagnosis"},
                                               {"c", "c: is not a state of egocal-pairing"}};
  std::filesystem::create_directory(path("said"));
  std::map<std::string, ChildProcess> started;  // each listens for a second first
  for (const auto& [state, what] : why)
    started.emplace(
        state, ChildProcess({paths::bin_dir() + "/egocal", "up", rig, "--state", path(state), "--output-dir",
                             path("out"), "--lcm-url", "udpm://239.255.76.67:7759?ttl=0"},
                            path("said/" + state)));
  for (auto& [state, egocal] : started) {
    EXPECT_EQ(egocal.wait(30s), 1) << state;
    const std::string said = read(path("said/" + state));
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    EXPECT_THAT(said, ::testing::StartsWith("egocal up: "));
    EXPECT_THAT(said, HasSubstr(why.at(state)));
  }
  std::vector<std::string> there;
  for (const auto& entry : std::filesystem::directory_iterator(path("")))
    there.push_back(entry.path().filename());
  EXPECT_THAT(there, ::testing::UnorderedElementsAre("drive.toml", "drive.log", "said", "text", "loop",
                                                     "a.lock", "b.diagnosis", "c"));
}

// The processes read it again and found it empty, without an end. A report that could not be written ended
// all.
TEST_F(Up, TakesARigThatCanBeReadOnceAndNeedsNoStandardError) {
  const std::string command = "cat '" + rig + "' | " + paths::bin_dir() + "/egocal up /dev/stdin --log '" +
                              log + "' --speed 0 --lcm-url 'udpm://239.255.76.67:7757?ttl=0' --output-dir '" +
                              path("out") + "' 2>&-";
  ChildProcess egocal({"sh", "-c", command}, path("said"));
  EXPECT_EQ(egocal.wait(60s), 0) << read(path("said"));
  EXPECT_THAT(read(path("said")), HasSubstr("lidar -> camera: good: "));
  ChildProcess full({"sh", "-c", paths::bin_dir() + "/egocal up '" + path("none.toml") + "' 2>/dev/full"});
  EXPECT_EQ(full.wait(10s), 1);
}

// It was "nothing was calibrated: pairing found no motion".
TEST_F(Up, ReportsThatStandardOutputIsGone) {
  ChildProcess egocal({"sh", "-c",
                       paths::bin_dir() + "/egocal up '" + rig + "' --log '" + log +
                           "' --follow --lcm-url 'udpm://239.255.76.67:7758?ttl=0' --output-dir '" +
                           path("out") + "' 2>'" + path("said") + "' >/dev/full"});
  EXPECT_EQ(egocal.wait(30s), 1);
  EXPECT_THAT(read(path("said")), HasSubstr("egocal up: standard output is gone"));
  EXPECT_THAT(read(path("said")), Not(HasSubstr("no motion")));
}

// It was killed by the signal, in the time in which it looks for another pairing.
TEST_F(Up, EndsWithCtrlCBeforeAnythingIsStarted) {
  const auto ended = [&](const std::vector<std::string>& more) {
    ChildProcess egocal = up(more);
    EXPECT_TRUE(until([&] {
      std::uint64_t caught = 0;
      for (const std::string& line : lines("/proc/" + std::to_string(egocal.pid()) + "/status"))
        if (line.starts_with("SigCgt:")) caught = std::stoull(line.substr(7), nullptr, 16);
      return (caught >> (SIGINT - 1) & 1) != 0;
    }));
    egocal.signal(SIGINT);
    return egocal.wait(10s);
  };
  EXPECT_EQ(ended({}), 0);
  EXPECT_EQ(ended({"--log", log}), 1);
  EXPECT_THAT(read(path("said")), HasSubstr("egocal up: ended before the log was played"));
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(Up, ChecksTheLogBeforeItPlaysIt) {
  {
    bus::LogWriter writer(path("other.log"));
    StampedPose pose;
    pose.time_us = 1'700'000'000'000'000;
    writer.write(pose.time_us, "SOMETHING_ELSE", bus::encode(bus::to_message(pose, 0)));
    writer.close();
  }
  ChildProcess other = up({"--log", path("other.log")});
  EXPECT_EQ(other.wait(30s), 1);
  EXPECT_EQ(lines(path("said")).size(), 1u) << read(path("said"));
  EXPECT_THAT(read(path("said")), HasSubstr("is not in the log; there are: SOMETHING_ELSE"));
}

TEST_F(Up, ASecondOneOnTheSameBusRefusesUnlessItIsToJoin) {
  const std::string url = "udpm://239.255.76.67:7754?ttl=0";
  bool runs = false;
  bus::Loop loop(url, bus::LoopOptions{.handle_signals = false});
  loop.subscribe<status_t>(bus::status_channel, [&](const status_t& status, const bus::Arrival&) {
    runs = runs || (status.name == "egocal-pairing" && status.state == "running");
  });
  ChildProcess first = up({"--lcm-url", url});
  ASSERT_TRUE(until([&] {
    loop.run_once(5ms);
    return runs;
  }));
  std::filesystem::remove(path("said"));
  ChildProcess second = up({"--lcm-url", url});
  EXPECT_EQ(second.wait(30s), 1);
  EXPECT_THAT(read(path("said")), HasSubstr("egocal-pairing (pid "));
  ChildProcess joined = up({"--lcm-url", url, "--join"});
  EXPECT_TRUE(until([&] { return child(joined.pid(), "egocal-pairing") > 0; }));
  for (ChildProcess* egocal : {&joined, &first}) {
    egocal->signal(SIGINT);
    EXPECT_EQ(egocal->wait(30s), 0);
  }
}

}  // namespace
}  // namespace egocal::test_up_start
