#include "serve/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include "core/base/error.hpp"

namespace langer {

namespace {

constexpr int grace = 30;  // tenths of a second between SIGTERM and SIGKILL

// Both ends are closed on exec: a program gets only the two that it writes to.
struct Pipe {
  std::array<int, 2> end{-1, -1};
  Pipe() {
    if (::pipe2(end.data(), O_CLOEXEC) != 0)
      throw Failure(Exit::input,
                    Error{{"langer serve"}, "", "no pipe can be made", "", std::strerror(errno)});
  }
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  void close_end(int which) {
    if (end[which] >= 0) ::close(end[which]);
    end[which] = -1;
  }
};

// The exit code as a shell gives it.
int code_of(int status) {
  if (WIFSIGNALED(status)) return 128 + WTERMSIG(status);
  return WEXITSTATUS(status);
}

// The keeper: only calls that are safe after a fork of a program with threads. `life` ends when
// the server does.
// It notices the server's end within 0.02 s, and the program's end as soon.
[[noreturn]] void keep(char* const* words, const char* folder, int life, int out, int err) {
  ::setpgid(0, 0);
  for (int fd = 3; fd < 1024; ++fd)
    if (fd != life && fd != out && fd != err) ::close(fd);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGPIPE}) std::signal(signal, SIG_DFL);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  const pid_t program = ::fork();
  if (program < 0) ::_exit(126);
  if (program == 0) {
    ::close(life);
    const int nothing = ::open("/dev/null", O_RDONLY);
    if (nothing >= 0) ::dup2(nothing, 0);
    ::dup2(out, 1);
    ::dup2(err, 2);
    if (::chdir(folder) != 0) ::_exit(126);
    ::execvp(words[0], words);
    ::_exit(127);
  }
  for (int fd : {0, 1, 2, out, err}) ::close(fd);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) std::signal(signal, SIG_IGN);
  int left = -1;  // tenths of a second until SIGKILL; -1: nobody has asked
  for (;;) {
    int status = 0;
    if (::waitpid(program, &status, WNOHANG) == program) {
      if (left >= 0) ::kill(0, SIGTERM);  // what it left behind
      ::_exit(code_of(status));
    }
    pollfd server{life, POLLIN, 0};
    int waits = 100;
    if (left < 0) waits = 20;
    if (left < 0 && ::poll(&server, 1, waits) != 0) {
      ::kill(0, SIGTERM);
      left = grace;
    } else if (left >= 0) {
      ::poll(nullptr, 0, waits);
      if (--left < 0) ::kill(0, SIGKILL);
    }
  }
}

}  // namespace

int run_child(const ChildCommand& command, const ChildOutput& output) {
  Pipe life, out, err;
  std::vector<char*> words;
  for (const std::string& word : command.words) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const pid_t keeper = ::fork();
  if (keeper < 0)
    throw Failure(
        Exit::input,
        Error{{command.words.front()}, "", "cannot be started", "", std::strerror(errno)});
  if (keeper == 0) keep(words.data(), command.folder.c_str(), life.end[0], out.end[1], err.end[1]);
  life.close_end(0);
  out.close_end(1);
  err.close_end(1);
  // A program that the first one leaves behind may hold the pipes open, so the keeper's end counts.
  bool asked = false;
  int status = 0;
  bool ended = false;
  std::array<char, 1 << 16> part;
  while (!ended) {
    ended = ::waitpid(keeper, &status, WNOHANG) == keeper;
    for (;;) {
      std::array<pollfd, 2> streams{pollfd{out.end[0], POLLIN, 0}, pollfd{err.end[0], POLLIN, 0}};
      int waits = 100;
      if (ended || (out.end[0] < 0 && err.end[0] < 0)) waits = 0;
      if (::poll(streams.data(), streams.size(), waits) <= 0) break;
      bool any = false;
      for (int k = 0; k < 2; ++k) {
        Pipe& from = k == 0 ? out : err;
        if (streams[k].revents == 0) continue;
        const ssize_t n = ::read(from.end[0], part.data(), part.size());
        if (n <= 0) {
          from.close_end(0);
          continue;
        }
        any = true;
        if (!output(k == 1, {part.data(), static_cast<std::size_t>(n)})) asked = true;
      }
      if (!any) break;
    }
    if (!output(false, "")) asked = true;
    if (asked) life.close_end(1);
    if (!ended && out.end[0] < 0 && err.end[0] < 0) ::poll(nullptr, 0, 10);
  }
  return code_of(status);
}

ChildResult run_child(const ChildCommand& command, double seconds, std::size_t largest,
                      const std::function<bool()>& ends) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  ChildResult result;
  result.code = run_child(command, [&](bool is_error, std::string_view text) {
    std::string& to = is_error ? result.err : result.out;
    to += text;
    const bool late = std::chrono::duration<double>(Clock::now() - begin).count() > seconds;
    if (late || to.size() > largest || ends()) result.stopped = true;
    return !result.stopped;
  });
  return result;
}

// LAUNCH and BIN would change which program the Makefile of a run starts.
void prepare_environment(const std::string& bin) {
  const char* path = std::getenv("PATH");
  ::setenv("PATH", (bin + ":" + (path ? path : "/usr/bin:/bin")).c_str(), 1);
  for (const char* name : {"MAKEFLAGS", "MFLAGS", "MAKELEVEL", "MAKEOVERRIDES", "MAKEFILES",
                           "LAUNCH", "BIN", "STRICT"})
    ::unsetenv(name);
  ::setenv("NO_COLOR", "1", 1);
}

}  // namespace langer
