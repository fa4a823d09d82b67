// What a child process that reads a stranger's file can do, and what it cannot.
#include "meshing/gmsh/child_process.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include <atomic>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "core/base/input_file.hpp"

using namespace langer;

namespace {

namespace fs = std::filesystem;

fs::path empty_folder() {
  const fs::path path = fs::temp_directory_path() / ("langer_child_" + std::to_string(getpid()));
  fs::remove_all(path);
  fs::create_directories(path);
  return path;
}

void nothing() {}

ChildAnswer answer_of(const std::function<std::string()>& work) {
  return run_in_child("", nothing, [&](const std::string&) { return work(); });
}

}  // namespace

TEST_CASE("a child process reads its private copy, computes, uses threads and answers") {
  const std::string big(3'000'000, 'x');
  const ChildAnswer answer = run_in_child(big, nothing, [](const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::stringstream bytes;
    bytes << in.rdbuf();
    std::string found = bytes.str();
    std::thread([&] { found += "y"; }).join();
    return found;
  });
  CHECK(answer.end == ChildEnd::done);
  CHECK(answer.bytes == big + "y");
}

TEST_CASE("a child process cannot start programs, connect or change files") {
  const fs::path folder = empty_folder();
  std::ofstream(folder / "victim") << "content";
  const int before = open((folder / "victim").c_str(), O_RDWR);  // the parent's descriptor
  const std::string victim = (folder / "victim").string();
  const std::string other = (folder / "other").string();
  const int parent = getpid();
  const ChildAnswer answer = answer_of([&] {
    std::string succeeded;
    const auto attempt = [&](const char* name, long result) {
      if (result >= 0) succeeded += std::string(name) + " ";
    };
    char program[] = "/bin/true";
    char* const arguments[] = {program, nullptr};
    attempt("execve", execve(program, arguments, nullptr));
    attempt("execveat", syscall(SYS_execveat, AT_FDCWD, program, arguments, nullptr, 0));
    const int touched = std::system(("touch " + other).c_str());
    if (touched == 0) succeeded += "system ";
    if (FILE* pipe = popen("true", "r")) {
      succeeded += "popen ";
      pclose(pipe);
    }
    attempt("fork", syscall(SYS_clone, SIGCHLD, nullptr, nullptr, nullptr, nullptr));
    attempt("clone3", syscall(SYS_clone3, nullptr, 0));
    attempt("socket", socket(AF_INET, SOCK_STREAM, 0));
    attempt("unix socket", socket(AF_UNIX, SOCK_STREAM, 0));
    attempt("creat", creat(other.c_str(), 0600));
    attempt("write", open(victim.c_str(), O_WRONLY));
    attempt("append", open(victim.c_str(), O_RDWR | O_APPEND));
    attempt("truncate on opening", open(victim.c_str(), O_RDONLY | O_TRUNC));
    attempt("create", open(other.c_str(), O_RDONLY | O_CREAT, 0600));
    attempt("nameless", open(fs::path(victim).parent_path().c_str(), O_TMPFILE | O_RDWR, 0600));
    attempt("openat2", syscall(SYS_openat2, AT_FDCWD, victim.c_str(), nullptr, 0));
    attempt("truncate", truncate(victim.c_str(), 0));
    attempt("unlink", unlink(victim.c_str()));
    attempt("rename", rename(victim.c_str(), other.c_str()));
    attempt("link", link(victim.c_str(), other.c_str()));
    attempt("symlink", symlink(victim.c_str(), other.c_str()));
    attempt("mkdir", mkdir(other.c_str(), 0700));
    attempt("mkfifo", mkfifo(other.c_str(), 0600));
    attempt("chmod", chmod(victim.c_str(), 0777));
    attempt("kill", kill(parent, SIGUSR1));
    attempt("tgkill", syscall(SYS_tgkill, parent, parent, SIGUSR1));
    attempt("ptrace", syscall(SYS_ptrace, 16, parent, 0, 0));
    attempt("process_vm_readv", syscall(SYS_process_vm_readv, parent, nullptr, 0, nullptr, 0, 0));
    attempt("io_uring", syscall(SYS_io_uring_setup, 1, nullptr));
    char letter = 'x';
    attempt("terminal input", ioctl(0, TIOCSTI, &letter));
    attempt("the parent's file", write(before, "x", 1));
    std::ofstream(other) << "x";
    return succeeded;
  });
  close(before);
  CHECK(answer.end == ChildEnd::done);
  if (answer.is_restricted) CHECK(answer.bytes == "");
  CHECK(read_file(victim) == "content");
  CHECK_FALSE(fs::exists(other));
  fs::remove_all(folder);
}

TEST_CASE("a child process has neither the environment nor the folder of its parent") {
  setenv("LANGER_TEST_WORD", "1", 1);
  const ChildAnswer answer = answer_of([] {
    const char* word = getenv("LANGER_TEST_WORD");
    return fs::current_path().string() + " " + getenv("HOME") + (word ? " word" : "");
  });
  CHECK(answer.bytes == "/ /nonexistent");
}

TEST_CASE("a crash, an exception and a failed preparation of a child process are answers") {
  CHECK(answer_of([]() -> std::string { throw std::runtime_error("no"); }).end == ChildEnd::failed);
  CHECK(answer_of([]() -> std::string { throw std::runtime_error("no"); }).bytes == "no");
  CHECK(answer_of([]() -> std::string { throw 5; }).end == ChildEnd::failed);
  const ChildAnswer aborted = answer_of([]() -> std::string { std::abort(); });
  CHECK(aborted.end == ChildEnd::crashed);
#if !defined(__SANITIZE_ADDRESS__)
  CHECK(aborted.bytes.find("signal 6") != std::string::npos);
#endif
  const ChildAnswer left = answer_of([]() -> std::string { _exit(0); });
  CHECK(left.end == ChildEnd::crashed);
  const ChildAnswer unprepared = run_in_child(
      "", [] { throw std::runtime_error("no library"); },
      [](const std::string&) { return std::string("work"); });
  CHECK(unprepared.end == ChildEnd::not_prepared);
  CHECK(unprepared.bytes == "no library");
}

TEST_CASE("a child process ends with its parent") {
  const pid_t parent = fork();
  REQUIRE(parent >= 0);
  if (parent == 0) {
    std::signal(SIGTERM, SIG_DFL);
    answer_of([] {
      std::this_thread::sleep_for(std::chrono::seconds(30));
      return std::string();
    });
    _exit(0);
  }
  std::string children;
  const std::string list =
      "/proc/" + std::to_string(parent) + "/task/" + std::to_string(parent) + "/children";
  for (int i = 0; i < 200 && children.empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    std::getline(std::ifstream(list), children);
  }
  REQUIRE_FALSE(children.empty());
  const pid_t child = std::stoi(children);
  kill(parent, SIGTERM);
  waitpid(parent, nullptr, 0);
  bool is_gone = false;
  for (int i = 0; i < 200 && !is_gone; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    // a zombie waits for the init process: it runs no more
    std::string line;
    std::ifstream stat("/proc/" + std::to_string(child) + "/stat");
    std::getline(stat, line);
    is_gone = line.empty() || line.find(") Z ") != std::string::npos;
  }
  CHECK(is_gone);
}

TEST_CASE("where the kernel has no filter, the answer says so and regular files stay unwritten") {
  const fs::path folder = empty_folder();
  const std::string other = (folder / "other").string();
  const pid_t tester = fork();
  REQUIRE(tester >= 0);
  if (tester == 0) {
    // a filter of ours that refuses further filters, as an old kernel would
    sock_filter steps[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_prctl, 0, 3),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, PR_SET_SECCOMP, 0, 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EINVAL),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
    };
    sock_fprog program{std::size(steps), steps};
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0) _exit(77);
    const ChildAnswer answer = answer_of([&] {
      std::ofstream(other) << "x" << std::flush;
      return std::string("done");
    });
    const bool is_right =
        answer.end == ChildEnd::done && answer.bytes == "done" && !answer.is_restricted;
    _exit(is_right ? 0 : 1);
  }
  int status = 0;
  waitpid(tester, &status, 0);
  REQUIRE(WIFEXITED(status));
  const int code = WEXITSTATUS(status);
  if (code != 77) {
    CHECK(code == 0);
    // it may be created there, but no byte gets in
    CHECK((!fs::exists(other) || fs::file_size(other) == 0));
  }
  fs::remove_all(folder);
}

TEST_CASE("a child process that computes for ever is stopped after its CPU time") {
  const auto loop = [](const std::string&) {
    for (std::atomic<int> n{0};;) ++n;
    return std::string();
  };
  const ChildAnswer answer = run_in_child("", nothing, loop, 1);
  CHECK(answer.end == ChildEnd::crashed);
  CHECK(answer.bytes == "it was stopped after 1 s of CPU time");
}
