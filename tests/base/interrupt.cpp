// Signals: what waits for a good place to stop, and what does not wait long.
#include "core/base/interrupt.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>

#include "core/base/stopwatch.hpp"

using namespace langer;

namespace {

struct Ended {
  int code;
  double seconds;
};
// of a process that does `work`, its words thrown away
Ended ended(const std::function<int()>& work) {
  const double start = wall_seconds();
  const pid_t child = fork();
  if (child == 0) {
    dup2(open("/dev/null", O_WRONLY), 2);
    listen_to_signals();
    _exit(work());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, wall_seconds() - start};
}

int busy(double seconds) {
  for (const double until = wall_seconds() + seconds; wall_seconds() < until;) {
  }
  return interrupted();
}

}  // namespace

TEST_CASE("a signal waits for a step, but where nothing would be lost not longer than it says") {
  const Ended waits = ended([] {
    const Interruptible step;
    raise(SIGINT);
    return busy(EndsSoon::seconds + 1.0);
  });
  CHECK(waits.code == SIGINT);  // interrupted(), at the end of the work
  for (bool before : {false, true}) {
    const Ended soon = ended([before] {
      const Interruptible step;
      if (before) raise(SIGTERM);
      const EndsSoon nothing_is_lost;
      if (!before) raise(SIGTERM);
      return busy(60);
    });
    CHECK(soon.code == 143);
    CHECK(soon.seconds > 0.5 * EndsSoon::seconds);
    CHECK(soon.seconds < 30);
  }
  for (int signal : {SIGINT, SIGTERM}) {  // of a person and of a scheduler
    const Ended one = ended([signal] {
      const Interruptible step;
      const EndsSoon without_the_step(SIGINT);
      raise(signal);
      return busy(EndsSoon::seconds + 1.0);
    });
    CHECK(one.code == (signal == SIGINT ? 130 : SIGTERM));
  }
  const Ended asked = ended([] {
    const Interruptible step;
    {
      const EndsSoon nothing_is_lost;
      raise(SIGINT);
    }
    return busy(EndsSoon::seconds + 1.0);  // what is left is writing
  });
  CHECK(asked.code == SIGINT);
  CHECK(ended([] { return raise(SIGINT); }).code == 130);  // nothing waits
}
