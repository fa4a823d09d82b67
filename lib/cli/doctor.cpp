#include "cli/doctor.hpp"

#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <thread>

#include "core/base/module_path.hpp"
#include "core/base/split.hpp"
#include "core/base/version.hpp"
#include "pipeline/plan/ports.hpp"
#include "report/page.hpp"

namespace langer {

namespace fs = std::filesystem;

namespace {

// first line of what a command of ours says; "" where it fails
std::string said_by(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen((command + " 2>/dev/null").c_str(), "r"),
                                                   pclose);
  std::array<char, 400> line{};
  if (!pipe || !std::fgets(line.data(), static_cast<int>(line.size()), pipe.get())) return "";
  std::string text = line.data();
  text.erase(std::find_if(text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }),
             text.end());
  return text;
}

std::string on_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  for (const std::string& folder : split(path ? path : "", ':'))
    if (const fs::path file = fs::path(folder) / program;
        access(file.c_str(), X_OK) == 0 && !fs::is_directory(file))
      return file.string();
  return "";
}

struct Tool {
  const char *program, *ask, *without, *install;
  bool needed = false;
};
constexpr Tool tools[]{
    {"make", "make --version", "pipelines cannot run", "make", true},
    {"gnuplot", "gnuplot --version",
     "figures are not drawn; their scripts and tables are there all the same", "gnuplot-nox"},
    {"python3", "python3 --version", "no Python package; all programs run without it", "python3"},
    {"sbatch", "sbatch --version", "langer-plan --slurm writes arrays for a machine that has Slurm",
     ""},
    {"snakemake", "", "langer-plan --snakemake writes a Snakefile for a machine that has it",
     "snakemake"},
    {"ccx", "ccx -v | grep -i version", "exported decks cannot be checked here", "calculix-ccx"},
    {"paraview", "", "snapshot_*.hdf and series.pvd open in ParaView on any machine", "paraview"},
};

Finding tool(const Tool& t) {
  const std::string where = on_path(t.program);
  std::string install;
  if (*t.install) install = fmt::format("; apt install {}", t.install);
  if (where.empty()) return {t.program, false, t.needed, t.without + install};
  std::string version;
  if (*t.ask) version = said_by(t.ask);
  return {t.program, true, t.needed,
          version.empty() ? where : fmt::format("{} ({})", where, version)};
}

Finding programs(const fs::path& bin) {
  std::string missing;
  std::size_t there = 0;
  std::vector<std::string> names = stage_names();
  names.push_back("plan");
  for (const std::string& name : names)
    access((bin / ("langer-" + name)).c_str(), X_OK) == 0 ? void(++there)
                                                          : void(missing += " langer-" + name);
  if (missing.empty())
    return {"programs", true, true, fmt::format("{} in {}", there + 1, bin.string())};
  return {
      "programs", false, true,
      fmt::format("missing in {}:{}; build or install Langer as a whole", bin.string(), missing)};
}

// what is loaded by a module of its own, whose libraries the loader has to find
Finding module(const std::string& name, const std::string& without, const std::string& package) {
  const std::string path = module_path(name);
  if (!fs::exists(path)) return {name, false, false, without + "; there is no " + path};
  if (const std::string lost = said_by("ldd '" + path + "' | grep 'not found'"); !lost.empty())
    return {name, false, false,
            fmt::format("{}; {}: apt install {} (Debian 12)", without,
                        lost.substr(lost.find_first_not_of(" \t")), package)};
  return {name, true, false, path};
}

Finding python_package(const char* name, const char* debian, const char* without) {
  const auto ask = [&](const char* python) {
    return said_by(fmt::format("{0} -c 'import {1}; print({1}.__version__)'", python, name));
  };
  const std::string version = ask("python3");
  if (version.empty() && !ask("/usr/bin/python3").empty())
    return {name, false, false,
            fmt::format(
                "{}: it is there for /usr/bin/python3, and `python3` is another; pip install {}",
                without, name)};
  if (version.empty())
    return {name, false, false, fmt::format("{}; apt install {}", without, debian)};
  return {name, true, false, version};
}

Finding machine() {
  struct statvfs disk {};
  double free = 0;
  if (statvfs(".", &disk) == 0) {
    free = 1e-9 * static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize);
  }
  const double memory = 1e-9 * static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
                        static_cast<double>(sysconf(_SC_PAGESIZE));
  return {"machine", true, false,
          fmt::format("{} processors, {:.3g} GB of memory, {:.3g} GB free on this disk",
                      std::thread::hardware_concurrency(), memory, free)};
}

}  // namespace

std::vector<Finding> examine() {
  const fs::path bin = fs::canonical("/proc/self/exe").parent_path();
  std::vector<Finding> findings{
      {"langer", true, true, fmt::format("{} ({})", version, revision)},
      machine(),
      programs(bin),
      module("gmsh",
             "solids from STEP and STL cannot be meshed; blocks, discs, .msh and .inp need no gmsh",
             "libgmsh4.8"),
      module("petsc", "bodies of more than 100 000 unknowns are factorized: more memory, more time",
             "libpetsc-real3.18")};
  findings.push_back(
      report::has_three()
          ? Finding{"three.js", true, false, "in langer-report"}
          : Finding{"three.js", false, false,
                    "reports have no body to turn; apt install libjs-three before building"});
  for (const Tool& t : tools) findings.push_back(tool(t));
  if (!on_path("python3").empty()) {
    findings.push_back(python_package("h5py", "python3-h5py", "langer.read() reads no HDF5 files"));
    findings.push_back(python_package("pandas", "python3-pandas", "no tables in Python"));
    findings.push_back(python_package("matplotlib", "python3-matplotlib", "no figures in Python"));
  }
  return findings;
}

std::string doctor_text(const std::vector<Finding>& findings) {
  std::size_t width = 0;
  for (const Finding& f : findings) width = std::max(width, f.what.size());
  std::string text;
  for (const Finding& f : findings)
    text += fmt::format("{}  {:<{}}  {}\n",
                        f.there    ? "yes"
                        : f.needed ? "NO "
                                   : "no ",
                        f.what, width, f.says);
  const auto lost = std::count_if(findings.begin(), findings.end(),
                                  [](const Finding& f) { return f.needed && !f.there; });
  return text + (lost == 0 ? "Langer runs here; what is missing is optional\n"
                           : "Langer does not run here: see NO\n");
}

}  // namespace langer
