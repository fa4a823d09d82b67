// kill -9 at random times in every program and in a whole pipeline; the next run must complete, and
// what it leaves must be what a run left alone leaves: HDF5 to 1e-12 outside /provenance, every
// other file byte by byte.
// --pages all: also every page of an unfinished solution zero, and random, as a power cut may leave
// it.
//   langer-soak <project> <programs> <folder of its own> --kills 200 [--seed 1] [--pages all] [--table kills.md]
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "support/compare_h5.hpp"

extern char** environ;
namespace fs = std::filesystem;
using Words = std::vector<std::string>;

namespace {

struct Job {
  std::string name;
  Words command;       // OUT stands for the folder of its results
  std::string needed;  // a file in OUT that is there at the end
};

struct Count {
  int kills = 0, ended_before = 0, with_part = 0, runs = 0;
  double seconds = 0;
};

struct Ended {
  int status = 0;
  double seconds = 0;
  bool exited() const { return WIFEXITED(status) && WEXITSTATUS(status) == 0; }
};

// runs it in its own process group, which is killed after `limit` seconds
Ended run(const fs::path& folder, Words command, const std::string& out, double limit,
          const fs::path& log) {
  for (std::string& word : command)
    if (const auto at = word.find("OUT"); at != std::string::npos) word.replace(at, 3, out);
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    setpgid(0, 0);
    const int fd = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(fd, 1), dup2(fd, 2);
    if (chdir(folder.c_str()) == 0) execvp(arguments[0], arguments.data());
    _exit(127);
  }
  setpgid(child, child);
  Ended ended;
  if (limit > 0) {
    while (seconds() < limit && waitpid(child, &ended.status, WNOHANG) == 0)
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    if (seconds() < limit) {
      ended.seconds = seconds();
      return ended;
    }
    kill(-child, SIGKILL);
  }
  waitpid(child, &ended.status, 0);
  ended.seconds = seconds();
  kill(-child, SIGKILL);  // grandchildren, which become children of this process
  for (int status = 0; waitpid(-child, &status, 0) > 0;) {
  }  // on a busy machine one that is killed may hold its lock for a while yet
  return ended;
}

std::string bytes(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

bool is_hdf5(const fs::path& path) {
  return path.extension() == ".h5" || path.extension() == ".hdf";
}
bool is_left_over(const fs::path& path) {
  return path.extension() == ".part" || path.extension() == ".lock" || path.extension() == ".log" ||
         path.extension() == ".steps";
}

Words differences(const fs::path& expected, const fs::path& found) {
  Words all;
  const auto files = [&](const fs::path& folder) {
    std::map<std::string, fs::path> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.is_regular_file() && !is_left_over(entry.path()))
        names[fs::relative(entry.path(), folder).string()] = entry.path();
    return names;
  };
  const auto in_expected = files(expected), in_found = files(found);
  for (const auto& [name, path] : in_expected) {
    const auto other = in_found.find(name);
    if (other == in_found.end())
      all.push_back(name + ": is missing");
    else if (is_hdf5(path)) {
      for (const auto& d : langer::support::compare_h5(path, other->second, 1e-12).differences)
        all.push_back(fmt::format("{}: {}: {}", name, d.where, d.what));
    } else if (path.extension() == ".html") {  // says when its files were made
      if (!bytes(other->second).ends_with("</html>\n")) all.push_back(name + ": not whole");
    } else if (bytes(path) != bytes(other->second))
      all.push_back(name + ": other bytes");
  }
  for (const auto& [name, path] : in_found)
    if (!in_expected.count(name)) all.push_back(name + ": is too much");
  return all;
}

// What a power cut may leave of an unfinished solution: each of its pages zero or random. The next
// run has to end with the expected file.
struct Pages {
  int scanned = 0, wrong = 0, failed = 0;
};
Pages scan_pages(const fs::path& project, const Job& solve, double duration,
                 const fs::path& expected, const fs::path& log, unsigned seed) {
  constexpr std::size_t page = 4096;
  const fs::path out = project / "out", part = out / "solution.h5.part",
                 steps = out / "solution.h5.steps";
  for (double share = 0.6; share > 0.05 && !fs::exists(steps); share *= 0.8) {
    fs::remove_all(out), fs::create_directories(out);
    run(project, solve.command, "out", share * duration, log);
    if (fs::exists(out / solve.needed)) fs::remove_all(out);
  }
  const std::string whole_part = bytes(part), whole_steps = bytes(steps);
  std::mt19937 random(seed);
  Pages pages;
  for (const bool of_part : {true, false})
    for (std::size_t at = 0; at < (of_part ? whole_part : whole_steps).size(); at += page)
      for (const bool zero : {true, false}) {
        fs::remove_all(out), fs::create_directories(out);
        std::string spoilt = of_part ? whole_part : whole_steps;
        for (std::size_t i = at; i < std::min(at + page, spoilt.size()); ++i)
          spoilt[i] = zero ? '\0' : static_cast<char>(random());
        std::ofstream(part, std::ios::binary) << (of_part ? spoilt : whole_part);
        std::ofstream(steps, std::ios::binary) << (of_part ? whole_steps : spoilt);
        const Ended end = run(project, solve.command, "out", 0, log);
        const bool failed = !end.exited();
        const Words wrong = failed ? Words{bytes(log)} : differences(expected, out);
        ++pages.scanned, pages.failed += failed, pages.wrong += !failed && !wrong.empty();
        if (!wrong.empty())
          std::printf("FAILED page %zu of %s, %s:\n%s\n", at / page, of_part ? ".part" : ".steps",
                      zero ? "zero" : "random", fmt::format("{}", fmt::join(wrong, "\n")).c_str());
      }
  return pages;
}

}  // namespace

int main(int argc, char** argv) {
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  if (argc < 4)
    return std::printf(
               "langer-soak <project> <programs> <folder> --kills 200 [--seed 1] [--table kills.md]\n"),
           2;
  const fs::path root = fs::canonical(argv[1]), bin = fs::absolute(argv[2]),
                 work = fs::absolute(argv[3]);
  int kills = 200;
  bool pages = false;
  unsigned seed = 1;
  std::string table;
  for (int i = 4; i + 1 < argc; i += 2) {
    const std::string option = argv[i];
    if (option == "--kills") kills = std::atoi(argv[i + 1]);
    if (option == "--seed") seed = static_cast<unsigned>(std::atoi(argv[i + 1]));
    if (option == "--table") table = argv[i + 1];
    if (option == "--pages") pages = std::string(argv[i + 1]) == "all";
  }
  fs::remove_all(work);
  fs::create_directories(work / "project");
  const fs::path project = work / "project";
  for (const char* folder : {"configs", "pipelines", "data"})
    fs::copy(root / folder, project / folder, fs::copy_options::recursive);
  const auto program = [&](const std::string& stage) {
    return (bin / ("langer-" + stage)).string();
  };
  const Words solve{program("solve"),
                    "configs/solve/smoke.yaml",
                    "--mesh",
                    "in/mesh.h5",
                    "--material",
                    "configs/material/abdomen_hgo_yeoh.yaml",
                    "--set",
                    "path.first=0.01",
                    "--set",
                    "path.largest=0.01",
                    "-o"};
  const auto ended = [&](Words command) {
    const fs::path log = work / "input.log";
    if (!run(project, std::move(command), "in", 0, log).exited())
      throw std::runtime_error(bytes(log));
  };
  const auto solve_to = [&](const std::string& output) {
    Words command = solve;
    command.push_back(output);
    return command;
  };
  // what the programs read
  fs::create_directories(project / "in");
  ended({program("mesh"), "configs/mesh/smoke.yaml", "-o", "in/mesh.h5"});
  ended({program("fit"), "configs/fit/abdomen_yeoh.yaml", "-o", "in/material.h5"});
  ended(solve_to("in/solution.h5"));
  ended({program("post"), "configs/post/smoke.yaml", "--solution", "in/solution.h5", "-o",
         "in/curves.h5"});
  std::ofstream(project / "table.yaml")
      << "columns: [force]\nmembers:\n  - {path: a, at: [\"1\"]}\n  - {path: b, at: [\"2\"]}\n"
         "axes: [{name: n, unit: \"-\"}]\n";
  std::ofstream(project / "ranks.yaml") << "{}\n";

  const std::vector<Job> jobs{
      {"mesh", {program("mesh"), "configs/mesh/indentation.yaml", "-o", "OUT/mesh.h5"}, "mesh.h5"},
      {"fit",
       {program("fit"), "configs/fit/abdomen_hgo.yaml", "--set", "starts=2", "-o",
        "OUT/material.h5"},
       "material.h5"},
      {"sensitivity",
       {program("sensitivity"), "ranks.yaml", "--material", "in/material.h5", "-o",
        "OUT/sensitivity.h5"},
       "sensitivity.h5"},
      {"solve", solve_to("OUT/solution.h5"), "solution.h5"},
      {"post",
       {program("post"), "configs/post/smoke.yaml", "--solution", "in/solution.h5", "-o",
        "OUT/curves.h5"},
       "curves.h5"},
      {"gather",
       {program("gather"), "table.yaml", "--curves", "in/curves.h5", "--curves", "in/curves.h5",
        "-o", "OUT/sweep.h5"},
       "sweep.h5"},
      // a plate pressed on and suction, a sphere that turns with friction, one that is pushed,
      // bonds that come loose, a block that is thrown at a wall
      {"suction",
       {program("solve"), "configs/solve/suction_plate.yaml", "-o", "OUT/solution.h5"},
       "solution.h5"},
      {"twist",
       {program("solve"), "configs/solve/twist_friction.yaml", "--set",
        "mesh.geometry.indented_block.edge=0.5", "-o", "OUT/solution.h5"},
       "solution.h5"},
      {"pushed",
       {program("solve"), "configs/solve/indentation_force.yaml", "--mesh", "in/mesh.h5", "-o",
        "OUT/solution.h5"},
       "solution.h5"},
      {"adhesion",
       {program("solve"), "configs/solve/pull_off.yaml", "--set",
        "mesh.geometry.indented_disc.edge=0.08", "-o", "OUT/solution.h5"},
       "solution.h5"},
      {"impact",
       {program("solve"), "configs/solve/impact.yaml", "-o", "OUT/solution.h5"},
       "solution.h5"},
      {"plan", {program("plan"), "pipelines/indentation_angles.yaml", "-o", "OUT"}, "Makefile"},
      {"make", {"make", "-j2", "-C", "OUT"}, "table/sweep.h5"},
  };
  std::mt19937 random(seed);
  std::map<std::string, Count> counts;
  int failures = 0, done = 0;
  std::map<std::string, double> duration;
  const auto fresh = [&](const Job& job, const std::string& out) {
    fs::remove_all(project / out);
    fs::create_directories(project / out);
    if (job.name == "make") ended({program("plan"), "pipelines/smoke.yaml", "-o", out});
  };
  // the same name in the two worlds, as commands and paths stand in some files
  for (const Job& job : jobs) {
    fresh(job, "out");
    const fs::path log = work / (job.name + ".log");
    const Ended whole = run(project, job.command, "out", 0, log);
    if (!whole.exited() || !fs::exists(project / "out" / job.needed))
      throw std::runtime_error(job.name + ":\n" + bytes(log));
    duration[job.name] = whole.seconds;
    fs::rename(project / "out", work / ("expected_" + job.name));
    fs::remove(log);
  }
  for (int turn = 0; done < kills; ++turn) {
    const Job& job = jobs[static_cast<std::size_t>(turn) % jobs.size()];
    Count& count = counts[job.name];
    count.seconds = duration[job.name];
    const fs::path log = work / "killed.log";
    fresh(job, "out");
    // several kills in a row, then one run to its end
    const int in_a_row = std::uniform_int_distribution<int>(1, 3)(random);
    Words times;
    for (int k = 0; k < in_a_row && done < kills; ++k) {
      const double limit =
          std::uniform_real_distribution<double>(0.001, 1.02 * duration[job.name])(random);
      times.push_back(fmt::format("{:.3f}", limit));
      const Ended end = run(project, job.command, "out", limit, log);
      if (WIFSIGNALED(end.status) && WTERMSIG(end.status) == SIGKILL)
        ++count.kills, ++done;
      else if (end.exited())
        ++count.ended_before;
      else {
        ++failures;
        std::printf("FAILED %s, seed %u, after %s s: ended by itself with status %d\n%s\n",
                    job.name.c_str(), seed, fmt::format("{}", fmt::join(times, ", ")).c_str(),
                    end.status, bytes(log).c_str());
      }
      for (const auto& entry : fs::recursive_directory_iterator(project / "out"))
        if (entry.path().extension() == ".part") {
          ++count.with_part;
          break;
        }
    }
    const Ended last = run(project, job.command, "out", 0, log);
    ++count.runs;
    const Words wrong =
        last.exited() ? differences(work / ("expected_" + job.name), project / "out")
                      : Words{fmt::format("ended with status {}\n{}", last.status, bytes(log))};
    if (wrong.empty()) continue;
    ++failures;
    std::printf("FAILED %s, seed %u, killed after %s s:\n%s\n", job.name.c_str(), seed,
                fmt::format("{}", fmt::join(times, ", ")).c_str(),
                fmt::format("{}", fmt::join(wrong, "\n")).c_str());
  }
  std::string text =
      "| program | a run alone, s | kills that met it running | runs that ended before | unfinished files left | "
      "runs to the end, all equal |\n"
      "| --- | --- | --- | --- | --- | --- |\n";
  for (const Job& job : jobs)
    if (const auto c = counts.find(job.name); c != counts.end())
      text +=
          fmt::format("| {} | {:.2f} | {} | {} | {} | {} |\n", job.name, c->second.seconds,
                      c->second.kills, c->second.ended_before, c->second.with_part, c->second.runs);
  text += fmt::format("\n{} kills, {} failures, seed {}\n", done, failures, seed);
  if (pages) {
    const Pages scan = scan_pages(project, jobs[3], duration["solve"], work / "expected_solve",
                                  work / "pages.log", seed);
    text += fmt::format(
        "\nEvery page of 4 kB of an unfinished solution and its journal, zero and random: {} runs, {} wrong results, {} that did not end well\n",
        scan.scanned, scan.wrong, scan.failed);
    failures += scan.wrong + scan.failed + (scan.scanned == 0);
  }
  std::printf("%s", text.c_str());
  if (!table.empty()) std::ofstream(table) << text;
  return failures == 0 ? 0 : 1;
}
