// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace egocal::test {

/// Hosts on one network segment: network namespaces joined by a bridge, each with an address 10.67.0.N and a
/// multicast route over its network interface. They exist as long as this object. To be made by a process
/// that is in a network namespace of its own already, and may make more (enter_network_namespace()).
class SeveralHosts {
 public:
  explicit SeveralHosts(int count) : SeveralHosts() {
    run("ip link add bridge type bridge mcast_snooping 0 && ip link set bridge up");
    for (int i = 0; i < count; ++i) {
      const std::string number = std::to_string(i + 1);
      const std::string port = port_of(i);
      holders_.push_back(hold_namespace());
      const std::string pid = std::to_string(holders_.back());
      run("ip link add " + port + " type veth peer name eth netns " + pid + " && ip link set " + port +
          " master bridge up");
      in_host(i, [&] {
        return std::system(
            ("ip link set lo up && ip addr add 10.67.0." + number +
             "/24 dev eth && ip link set eth up multicast on && ip route add 224.0.0.0/4 dev eth")
                .c_str());
      });
    }
  }
  ~SeveralHosts() {
    for (std::size_t i = 0; i < holders_.size(); ++i) {
      // by name, because the kernel removes a namespace without processes late, and the next object would
      // find its interfaces
      std::system(("ip link del " + port_of(static_cast<int>(i))).c_str());
      ::kill(holders_[i], SIGKILL);
      waitpid(holders_[i], nullptr, 0);
    }
    std::system("ip link del bridge");
  }
  SeveralHosts(const SeveralHosts&) = delete;
  SeveralHosts& operator=(const SeveralHosts&) = delete;

  /// Moves the calling thread, and whatever it starts, to the network of that host.
  void enter(int host) const { set_namespace("/proc/" + std::to_string(holders_[index(host)]) + "/ns/net"); }

  /// Calls the function on that host and returns to this one; sockets made there stay there. 0: success.
  void in_host(int host, const std::function<int()>& what) const {
    const int home = open("/proc/self/ns/net", O_RDONLY | O_CLOEXEC);
    enter(host);
    const int result = what();
    if (setns(home, CLONE_NEWNET) != 0) std::perror("setns");
    close(home);
    if (result != 0) throw std::runtime_error("failed on host " + std::to_string(host + 1));
  }

 private:
  /// Delegated to, so that the destructor removes what was made if the rest fails.
  SeveralHosts() = default;

  static std::string port_of(int host) { return "port" + std::to_string(host + 1); }
  static std::size_t index(int host) { return static_cast<std::size_t>(host); }
  static void run(const std::string& command) {
    if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
  }
  static void set_namespace(const std::string& file) {
    const int fd = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    const int result = fd < 0 ? -1 : setns(fd, CLONE_NEWNET);
    if (fd >= 0) close(fd);
    if (result != 0) throw std::runtime_error("cannot enter " + file);
  }
  /// A process that only keeps a network namespace alive.
  static pid_t hold_namespace() {
    int ready[2];
    if (pipe2(ready, O_CLOEXEC) != 0) throw std::runtime_error("pipe failed");
    const pid_t pid = fork();
    if (pid < 0) throw std::runtime_error("fork failed");
    if (pid == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      const char answer = unshare(CLONE_NEWNET) == 0 ? 'y' : 'n';
      if (write(ready[1], &answer, 1) != 1) _exit(1);
      for (;;) pause();
    }
    close(ready[1]);
    char answer = 'n';
    const bool told = read(ready[0], &answer, 1) == 1;
    close(ready[0]);
    if (!told || answer != 'y') throw std::runtime_error("cannot make a network namespace");
    return pid;
  }

  std::vector<pid_t> holders_;
};

}  // namespace egocal::test
