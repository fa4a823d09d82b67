// Runs work on a stranger's file in a child process that can compute and read, and nothing else.
//
// Libraries for CAD are large and were not written for hostile files. The child is a copy of this
// process (fork). It first loads what it needs; then the kernel is asked to refuse it every system
// call outside a short list (seccomp): it cannot start programs, open connections, or create, open
// for writing, rename or remove files. Its input is a copy in memory, under a name that no other
// file shares, so a library finds no settings next to it; HOME and the other variables of the
// environment are gone. The answer comes back through a pipe. If the child crashes, that is an
// answer too; if this process ends, the kernel ends the child.
#pragma once

#include <functional>
#include <string>

namespace langer {

constexpr int longest_child = 600;  // [s] of CPU time

enum class ChildEnd {
  done,          // bytes: what `work` returned
  failed,        // bytes: what it threw
  not_prepared,  // bytes: what `prepare` threw
  crashed        // bytes: how it ended, in words
};

struct ChildAnswer {
  ChildEnd end = ChildEnd::crashed;
  std::string bytes;
  bool is_restricted = true;  // false: this kernel has no seccomp
};

// `prepare` runs before the restriction, `work` with the path of the copy of `file` after it. Both
// may throw std::exception. A signal that asks this program to end also ends the child, and throws
// Failure with the signal's code where it does not end the program at once. A child that needs more
// than `cpu_seconds` of CPU time is stopped: some surfaces send gmsh into an endless loop.
ChildAnswer run_in_child(const std::string& file, const std::function<void()>& prepare,
                         const std::function<std::string(const std::string& path)>& work,
                         int cpu_seconds = longest_child);

// Restricts the calling process for the rest of its life. Returns false if the kernel cannot.
bool restrict_this_process();

}  // namespace langer
