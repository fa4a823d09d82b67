#include "meshing/gmsh/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <stdexcept>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/interrupt.hpp"
#include "core/base/memory.hpp"

namespace langer {

namespace {

// The first two bytes of an answer: whether the child is restricted, and how its work ended.
constexpr char restricted = 'r';
constexpr char unrestricted = 'u';
constexpr char done = 'd';
constexpr char failed = 'f';
constexpr char not_prepared = 'n';

void write_all(int descriptor, const std::string& bytes) {
  std::size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t n = write(descriptor, bytes.data() + written, bytes.size() - written);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw std::runtime_error(std::strerror(errno));
    written += static_cast<std::size_t>(n);
  }
}

// A file in memory, under a path that only this process has.
std::string private_copy(const std::string& bytes) {
  const int descriptor = memfd_create("input", 0);
  if (descriptor < 0)
    throw std::runtime_error(
        fmt::format("a private copy cannot be made: {}", std::strerror(errno)));
  write_all(descriptor, bytes);
  return fmt::format("/proc/self/fd/{}", descriptor);
}

void limit(int resource, rlim_t most) {
  const rlimit both{most, most};
  setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

// Signals, descriptors, environment and limits of a process that is on its own.
void isolate_process(int parent, int answer) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // it ended before that
  std::signal(SIGINT, SIG_IGN);       // the terminal sends it to both; the parent decides
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int signal : {SIGTERM, SIGALRM, SIGPIPE}) std::signal(signal, SIG_DFL);
  alarm(0);

  const int nothing = open("/dev/null", O_RDWR);
  dup2(nothing, 0);
  dup2(nothing, 1);
#if !defined(__SANITIZE_ADDRESS__)
  dup2(nothing, 2);
#endif
  // all others are the parent's: its outputs, locks and connections
  const int last = static_cast<int>(sysconf(_SC_OPEN_MAX));
  for (int descriptor = 3; descriptor < std::min(last, 65536); ++descriptor)
    if (descriptor != answer) close(descriptor);

  clearenv();
  setenv("HOME", "/nonexistent", 1);
  if (chdir("/") != 0) _exit(1);
  limit(RLIMIT_CORE, 0);
}

[[noreturn]] void run_child(int parent, int answer, const std::string& file,
                            const std::function<void()>& prepare,
                            const std::function<std::string(const std::string&)>& work,
                            int cpu_seconds) {
  char mode = unrestricted;
  const auto end_with = [&](char kind, const std::string& bytes) {
    try {
      write_all(answer, std::string{mode, kind} + bytes);
    } catch (const std::exception&) {
      _exit(1);
    }
    _exit(0);  // not exit: what the parent registered for its end is not ours
  };
  std::string path;
  try {
    isolate_process(parent, answer);
    prepare();
    if (!file.empty()) path = private_copy(file);
  } catch (const std::exception& error) {
    end_with(not_prepared, error.what());
  }
  // No byte into any regular file, whether the kernel has the filter or not.
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_CPU, static_cast<rlim_t>(cpu_seconds));
  if (restrict_this_process()) mode = restricted;
  try {
    end_with(done, work(path));
  } catch (const std::exception& error) {
    end_with(failed, error.what());
  } catch (...) {
    end_with(failed, "no reason given");
  }
  _exit(1);
}

class Child {
 public:
  explicit Child(pid_t process) : process_(process) {}
  ~Child() {
    if (process_ <= 0) return;
    kill(process_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  int wait() {
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return status;
  }

 private:
  pid_t process_;
};

// All that comes through the pipe until the child closes it. The child is killed if it sends more
// than the memory holds, and if a signal asks this program to end.
std::string read_answer(int pipe) {
  const double most_bytes = 0.5 * free_memory();
  std::string bytes;
  std::array<char, 1 << 16> block;
  while (true) {
    if (const int signal = interrupted(); signal != 0)
      throw Failure(exit_code_of(signal),
                    Error{{}, "", fmt::format("stopped by {}", signal_name(signal)), "", ""});
    pollfd waiting{pipe, POLLIN, 0};
    if (poll(&waiting, 1, 100) <= 0) continue;
    const ssize_t n = read(pipe, block.data(), block.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return bytes;
    bytes.append(block.data(), static_cast<std::size_t>(n));
    if (static_cast<double>(bytes.size()) > most_bytes)
      throw std::runtime_error("its answer does not fit into the memory");
  }
}

std::string end_in_words(int status, int cpu_seconds) {
  // Both limits of RLIMIT_CPU are equal, so the kernel may send either signal.
  const bool by_signal = WIFSIGNALED(status);
  if (by_signal && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL)) {
    return fmt::format("it was stopped after {} s of CPU time", cpu_seconds);
  }
  if (WIFSIGNALED(status))
    return fmt::format("it ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  return fmt::format("it ended with code {} before it was done", WEXITSTATUS(status));
}

}  // namespace

ChildAnswer run_in_child(const std::string& file, const std::function<void()>& prepare,
                         const std::function<std::string(const std::string& path)>& work,
                         int cpu_seconds) {
  const auto refuse = [](const char* action) {
    throw Failure(Exit::input, Error{{},
                                     "",
                                     fmt::format("{}: {}", action, std::strerror(errno)),
                                     "",
                                     "gmsh runs in a separate process"});
  };
  std::array<int, 2> ends;
  if (pipe2(ends.data(), O_CLOEXEC) != 0) refuse("no pipe can be made");
  const int parent = getpid();
  const pid_t process = fork();
  if (process == 0) run_child(parent, ends[1], file, prepare, work, cpu_seconds);
  close(ends[1]);
  if (process < 0) {
    close(ends[0]);
    refuse("no process can be started");
  }

  Child child(process);
  ChildAnswer answer;
  std::string bytes;
  try {
    bytes = read_answer(ends[0]);
  } catch (const std::runtime_error& error) {
    close(ends[0]);
    answer.bytes = error.what();
    return answer;
  } catch (...) {
    close(ends[0]);
    throw;
  }
  close(ends[0]);
  const int status = child.wait();
  const bool is_whole = bytes.size() >= 2 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (!is_whole) {
    answer.bytes = end_in_words(status, cpu_seconds);
    return answer;
  }
  answer.is_restricted = bytes[0] == restricted;
  if (bytes[1] == done) answer.end = ChildEnd::done;
  if (bytes[1] == failed) answer.end = ChildEnd::failed;
  if (bytes[1] == not_prepared) {
    answer.end = ChildEnd::not_prepared;
    answer.is_restricted = true;  // nothing of the file was read
  }
  answer.bytes = bytes.substr(2);
  return answer;
}

}  // namespace langer
