// Programs that the server starts: Langer's own, and make. Nothing else, and never by a shell.
//
// Each of them runs in a process group of its own below a keeper, a fork of the server that only
// waits. When the program has ended, so does the keeper, with its exit code. When the server ends,
// however it ends, the pipe between them closes, and the keeper ends the whole group: first by
// SIGTERM, after which a solve keeps its finished steps, then by SIGKILL.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace langer {

struct ChildCommand {
  std::vector<std::string> words;  // the program and its arguments
  std::string folder;              // where it runs
};

struct ChildResult {
  int code = 0;  // 128 + n: ended by signal n
  std::string out, err;
  bool stopped = false;  // because it took too long, or because it was told to
};

// Called with what a program writes, as it comes. False: the program has to end.
using ChildOutput = std::function<bool(bool is_error, std::string_view text)>;

// Runs a program to its end. `output` is called at least every 0.1 s, with an empty text if there
// is nothing new.
int run_child(const ChildCommand& command, const ChildOutput& output);

// The same with all that it wrote, at most `largest` bytes of each stream, within `seconds`.
ChildResult run_child(const ChildCommand& command, double seconds, std::size_t largest,
                      const std::function<bool()>& ends);

// Lets programs find each other: Langer's own folder first, and nothing that a make around the
// server has set. Call once, before any thread.
void prepare_environment(const std::string& bin);

}  // namespace langer
