#include "relations/solve.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace langer::relations {

namespace {

// A clock of CPU time that ends the process, and that exec does not stop. SIGPROF is not caught by
// langer-solve, so this is a kill; unlike a kill from outside it comes at the same place on a busy
// machine.
void end_after(double seconds) {
  itimerval timer{};
  const double whole = std::floor(seconds);
  timer.it_value.tv_sec = static_cast<time_t>(whole);
  timer.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (seconds - whole)) + 1;
  setitimer(ITIMER_PROF, &timer, nullptr);
}

[[noreturn]] void become(const std::filesystem::path& program, const std::filesystem::path& yaml,
                         double seconds) {
  const std::string log = yaml.stem().string() + ".log";
  const std::string output = yaml.stem().string() + ".h5";
  const std::string name = yaml.filename().string();
  if (chdir(yaml.parent_path().c_str()) != 0) {
    _exit(127);
  }
  const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  dup2(file, 1);
  dup2(file, 2);
  end_after(seconds);
  execl(program.c_str(), program.c_str(), name.c_str(), "-o", output.c_str(), nullptr);
  _exit(127);
}

}  // namespace

std::string Answer::end() const {
  if (signal == SIGPROF) {
    return fmt::format("no end after {:.3g} s of CPU time", cpu_seconds);
  }
  if (signal != 0) {
    return fmt::format("signal {} ({})", signal, strsignal(signal));
  }
  return fmt::format("exit code {}", code);
}

Answer Solver::solve(const std::filesystem::path& yaml, std::optional<double> kill_after) const {
  const pid_t child = fork();
  if (child < 0) {
    throw std::runtime_error("fork failed");
  }
  if (child == 0) {
    become(program, yaml, kill_after.value_or(limit));
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);

  Answer answer;
  answer.cpu_seconds = static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                       1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
  if (WIFSIGNALED(status)) {
    answer.signal = WTERMSIG(status);
  } else {
    answer.code = WEXITSTATUS(status);
  }
  const std::filesystem::path stem = yaml.parent_path() / yaml.stem();
  std::ifstream log(stem.string() + ".log");
  answer.log.assign(std::istreambuf_iterator<char>(log), {});
  if (!answer.solved() || kill_after) {
    return answer;
  }
  const SolutionReader reader(stem.string() + ".h5");
  answer.mesh = reader.header().mesh;
  for (int i = 0; i < reader.n_steps(); ++i) {
    answer.steps.push_back(reader.step(i));
  }
  return answer;
}

}  // namespace langer::relations
