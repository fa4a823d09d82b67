// The frame of every program. A program ends by _exit() after its files are written and closed: the
// clean-up of some libraries is slow, or fails when memory has run out.
#include "program.hpp"

#include <sys/resource.h>
#include <unistd.h>
#ifdef LANGER_SANITIZE
#include <sanitizer/lsan_interface.h>
#endif

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <new>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/interrupt.hpp"
#include "core/base/memory.hpp"
#include "core/base/output_file.hpp"
#include "core/base/printable.hpp"
#include "core/base/ranks.hpp"
#include "core/base/say.hpp"
#include "core/base/stopwatch.hpp"
#include "core/base/traps.hpp"
#include "core/base/version.hpp"
#include "mechanics/linear/petsc/petsc_load.hpp"
#include "pipeline/plan/run_files.hpp"

namespace langer {

// Ranks other than the first print nothing.
void put_out(const std::string& text) {
  if (said::silent) return;
  errno = 0;
  if ((std::fwrite(text.data(), 1, text.size(), stdout) != text.size() ||
       std::fflush(stdout) != 0) &&
      errno != EPIPE)
    throw Failure(
        Exit::input,
        Error{{"stdout"}, "", fmt::format("cannot be written ({})", std::strerror(errno)), "", ""});
}

std::string version_line(const std::string& program) {
  return fmt::format("{} {} ({})", program, version, revision);
}

std::string command_line(int argc, char** argv) {
  std::string line = std::filesystem::path(argv[0]).filename().string();
  for (int i = 1; i < argc; ++i) line += std::string(" ") + argv[i];
  // The line is a comment in logs and Makefiles, which a line break would end.
  for (char& c : line) {
    if (is_control(c)) c = '?';
  }
  return line;
}

RunLog::~RunLog() {
  if (said::log) std::fclose(std::exchange(said::log, nullptr));
}

void RunLog::open(const std::string& path, const std::string& command, bool continued) {
  if (said::silent) return;
  require_own_log(path);
  std::error_code failed;  // if the folder cannot be made, opening the file fails below
  if (const auto folder = std::filesystem::path(path).parent_path(); !folder.empty())
    std::filesystem::create_directories(folder, failed);
  said::log = open_log_file(path, continued);
  if (!said::log)
    throw Failure(Exit::input, Error{{path},
                                     "",
                                     fmt::format("cannot be written ({})", std::strerror(errno)),
                                     "a file in a folder that may be written to",
                                     "another name for --log"});
  fmt::print(said::log, "# {}\n# {} on {}, {}\n", command, version_line("langer"), host_name(),
             utc_now());
  std::fflush(said::log);
}

namespace {

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

// CPU seconds of programs that were started here and have ended, such as gnuplot.
double cpu_seconds_of_children() {
  rusage used{};
  if (getrusage(RUSAGE_CHILDREN, &used) != 0) return 0;
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

// The last line of a log, which `langer times` reads (cli/run_state.hpp).
void end_log(int code) {
  if (said::log)
    fmt::print(said::log, "# end: exit {}, {:.2f} s, {:.2f} s of CPU, {:.0f} MB\n", code,
               wall_seconds(), cpu_seconds() + cpu_seconds_of_children(), 1e-6 * peak_bytes());
}

// Prints why this rank has failed while rank 0, which prints all messages, has not.
void print_rank_error(const char* reason) {
  std::fprintf(stderr, "rank %d: %s\n", launched().rank, reason);
}

// Ends a program whose work is done. If memory or disk have run out, libraries hang or crash in
// their own clean-up: OpenBLAS joins a thread that waits for memory, and HDF5 tries again to write
// data that could not be written. So _exit() skips it.
[[noreturn]] void leave(int code) {
  std::fflush(nullptr);
  // The first rank that fails ends all others. Wait, so that it is the one with the message.
  if (said::silent && !ranks() && code != 0) sleep(1);
  if (ranks()) code = ranks()->end(code, code != 0, print_rank_error, said::unsaid);
  if (ranks() || code != static_cast<int>(Exit::input)) end_petsc();
#ifdef LANGER_SANITIZE
  __lsan_do_leak_check();
#endif
  _exit(code);
}

// Lack of memory counts as a problem of the input: a smaller scene works.
int report_no_memory(const std::string& program, const char* detail) {
  say_line(
      "{}: out of memory{}\n  hint: fewer elements, fewer threads, or a higher limit (ulimit -v)",
      program, detail);
  return static_cast<int>(Exit::input);
}

// Runs the body and turns an exception into a message and an exit code.
int exit_code_after(const std::string& program, const std::function<int()>& body) {
  wall_seconds();  // starts the clock
  listen_to_signals(said::silent);
  set_traps();
  try {
    return body();
  } catch (const EndedByRoot&) {
    return static_cast<int>(Exit::ok);  // all ranks end with the code of rank 0
  } catch (const Failure& failure) {
    say_error(failure.what());
    return static_cast<int>(failure.code());
  } catch (const std::bad_alloc&) {
    return report_no_memory(program, "");
  } catch (const std::system_error& e) {
    if (e.code() == std::errc::resource_unavailable_try_again ||
        e.code() == std::errc::not_enough_memory)
      return report_no_memory(program, ": no further thread can be started");
    say_line("{}: {}", program, e.what());
    return static_cast<int>(Exit::input);
  } catch (const std::exception& e) {
    say_line("{} {} ({}): {}\n  this is a bug, please report it with the command and its files",
             program, version, revision, e.what());
  }
  return static_cast<int>(Exit::bug);
}

}  // namespace

// All programs pass through here, also when they fail.
int guarded(const std::string& program, const std::function<int()>& body) {
  said::silent = launched().rank > 0;
  if (said::silent && program != shared_by_ranks) _exit(0);
  const int code = exit_code_after(program, body);
  end_log(code);
  leave(code);
}

}  // namespace langer
