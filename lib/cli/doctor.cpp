// `langer doctor`. Versions are found by running the programs themselves, as a user would.
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
#include "mechanics/linear/blas/kernels.hpp"
#include "pipeline/plan/ports.hpp"
#include "report/page.hpp"

namespace langer {

namespace fs = std::filesystem;

namespace {

// The first line that a command prints; empty if it fails. The commands are constants of this file.
std::string first_output_line(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen((command + " 2>/dev/null").c_str(), "r"),
                                                   pclose);
  std::array<char, 400> line{};
  if (!pipe || !std::fgets(line.data(), static_cast<int>(line.size()), pipe.get())) return "";
  const std::string text = line.data();
  return text.substr(0, text.find_first_of("\r\n"));
}

// The file of a program on the PATH; empty if there is none.
std::string on_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  if (!path) return "";
  for (const std::string& folder : split(path, ':')) {
    const fs::path file = fs::path(folder) / program;
    if (access(file.c_str(), X_OK) == 0 && !fs::is_directory(file)) return file.string();
  }
  return "";
}

// A program that Langer can use.
struct Tool {
  const char* program;
  const char* ask;      // command that prints its version; may be empty
  const char* without;  // what does not work without it
  const char* install;  // package of Debian; may be empty
  bool needed = false;
};
// What works without a tool is said, because most users need only some of them.
constexpr Tool tools[]{
    {"make", "make --version", "pipelines cannot run", "make", true},
    {"gnuplot", "gnuplot --version",
     "figures are not drawn; their scripts and tables are written anyway", "gnuplot-nox"},
    {"python3", "python3 --version", "no Python package; all programs run without it", "python3"},
    {"sbatch", "sbatch --version", "langer-plan --slurm writes arrays for a machine that has Slurm",
     ""},
    {"snakemake", "", "langer-plan --snakemake writes a Snakefile for a machine that has it",
     "snakemake"},
    {"ccx", "ccx -v | grep -i version", "exported decks cannot be checked here", "calculix-ccx"},
    {"paraview", "", "snapshot_*.hdf and series.pvd open in ParaView on any machine", "paraview"},
};

// Looks for a program and asks for its version.
Finding tool(const Tool& t) {
  const std::string where = on_path(t.program);
  std::string install;
  if (*t.install) install = fmt::format("; apt install {}", t.install);
  if (where.empty()) return {t.program, false, t.needed, t.without + install};
  std::string version;
  if (*t.ask) version = first_output_line(t.ask);
  if (version.empty()) return {t.program, true, t.needed, where};
  return {t.program, true, t.needed, fmt::format("{} ({})", where, version)};
}

// Whether all programs of Langer are in the folder of this one.
Finding programs(const fs::path& bin) {
  std::string missing;
  std::size_t there = 0;
  std::vector<std::string> names = stage_names();
  names.push_back("plan");
  for (const std::string& name : names) {
    if (access((bin / ("langer-" + name)).c_str(), X_OK) == 0)
      ++there;
    else
      missing += " langer-" + name;
  }
  if (missing.empty())
    return {"programs", true, true, fmt::format("{} in {}", there + 1, bin.string())};
  return {
      "programs", false, true,
      fmt::format("missing in {}:{}; build or install Langer as a whole", bin.string(), missing)};
}

// A library that is loaded at run time by a module of Langer (gmsh, PETSc, cpp-httplib). It may be
// missing although the module is there; ldd shows that.
Finding module(const std::string& name, const std::string& without, const std::string& package) {
  const std::string path = module_path(name);
  if (!fs::exists(path)) return {name, false, false, without + "; there is no " + path};
  const std::string missing = first_output_line("ldd '" + path + "' | grep 'not found'");
  if (!missing.empty())
    return {name, false, false,
            fmt::format("{}; {}: apt install {} (Debian 12)", without,
                        missing.substr(missing.find_first_not_of(" \t")), package)};
  return {name, true, false, path};
}

// A package of Python. It may be installed for the system's Python only, while `python3` is another
// one.
Finding python_package(const char* name, const char* debian, const char* without) {
  const auto ask = [&](const char* python) {
    return first_output_line(
        fmt::format("{0} -c 'import {1}; print({1}.__version__)'", python, name));
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

// Processors, memory and free disk space. Large scenes need all three, so they are part of a report
// about a problem.
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

// Packages of Python are looked for only if there is a Python.
std::vector<Finding> examine() {
  const fs::path bin = program_folder();
  std::vector<Finding> findings{
      {"langer", true, true, fmt::format("{} ({})", version, revision)},
      machine(),
      programs(bin),
      module("gmsh",
             "solids from STEP and STL cannot be meshed; blocks, discs, .msh and .inp need no gmsh",
             "libgmsh4.8"),
      module("petsc", "bodies of more than 100 000 unknowns are factorized: more memory, more time",
             "libpetsc-real3.18"),
      module("http", "langer serve has no page", "libcpp-httplib0.11")};
  if (const std::string kernels = blas::kernels_line(); !kernels.empty())
    findings.push_back({"BLAS", true, false, kernels});
  if (report::has_three())
    findings.push_back({"three.js", true, false, "in langer-report"});
  else
    findings.push_back({"three.js", false, false,
                        "reports have no body to turn; apt install libjs-three before building"});
  for (const Tool& t : tools) findings.push_back(tool(t));
  if (!on_path("python3").empty()) {
    findings.push_back(python_package("h5py", "python3-h5py", "langer.read() reads no HDF5 files"));
    findings.push_back(python_package("pandas", "python3-pandas", "no tables in Python"));
    findings.push_back(python_package("matplotlib", "python3-matplotlib", "no figures in Python"));
  }
  return findings;
}

// A table with one line for each finding. NO in capitals is a needed one.
std::string doctor_text(const std::vector<Finding>& findings) {
  std::size_t width = 0;
  for (const Finding& f : findings) width = std::max(width, f.what.size());
  std::string text;
  for (const Finding& f : findings) {
    std::string answer = "no ";
    if (f.there) answer = "yes";
    if (is_serious(f)) answer = "NO ";
    text += fmt::format("{}  {:<{}}  {}\n", answer, f.what, width, f.says);
  }
  if (std::ranges::any_of(findings, is_serious)) return text + "Langer does not run here: see NO\n";
  return text + "Langer runs here; what is missing is optional\n";
}

}  // namespace langer
