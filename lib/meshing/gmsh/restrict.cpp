// The list of system calls that a restricted process may make.
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <vector>

#include "meshing/gmsh/child_process.hpp"

namespace langer {

#if defined(__x86_64__) || defined(__aarch64__)

namespace {

#if defined(__x86_64__)
constexpr std::uint32_t architecture = AUDIT_ARCH_X86_64;
#else
constexpr std::uint32_t architecture = AUDIT_ARCH_AARCH64;
#endif

// A program for the kernel's filter: small steps over the number and the arguments of a call.
class Filter {
 public:
  Filter() {
    load(offsetof(seccomp_data, arch));
    add(BPF_JMP | BPF_JEQ | BPF_K, architecture, 1, 0);
    finish(SECCOMP_RET_KILL_PROCESS);
    load(offsetof(seccomp_data, nr));
  }

  void allow(int number) {
    skip_unless(number, 1);
    finish(SECCOMP_RET_ALLOW);
  }

  void refuse(int number, int error) {
    skip_unless(number, 1);
    finish(SECCOMP_RET_ERRNO | static_cast<std::uint32_t>(error));
  }

  // Allows a call if none of these bits is set in its argument.
  void allow_without_bits(int number, int argument, std::uint32_t bits, int error) {
    skip_unless(number, 4);
    load_argument(argument);
    add(BPF_JMP | BPF_JSET | BPF_K, bits, 1, 0);
    finish(SECCOMP_RET_ALLOW);
    finish(SECCOMP_RET_ERRNO | static_cast<std::uint32_t>(error));
  }

  void allow_with_bits(int number, int argument, std::uint32_t bits, int error) {
    skip_unless(number, 4);
    load_argument(argument);
    add(BPF_JMP | BPF_JSET | BPF_K, bits, 0, 1);
    finish(SECCOMP_RET_ALLOW);
    finish(SECCOMP_RET_ERRNO | static_cast<std::uint32_t>(error));
  }

  void allow_with_value(int number, int argument, std::uint32_t value, int error) {
    skip_unless(number, 4);
    load_argument(argument);
    add(BPF_JMP | BPF_JEQ | BPF_K, value, 0, 1);
    finish(SECCOMP_RET_ALLOW);
    finish(SECCOMP_RET_ERRNO | static_cast<std::uint32_t>(error));
  }

  bool install() {
    finish(SECCOMP_RET_ERRNO | ENOSYS);  // whatever is not on the list
    sock_fprog program{};
    program.len = static_cast<unsigned short>(steps_.size());
    program.filter = steps_.data();
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return false;
    return prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
  }

 private:
  std::vector<sock_filter> steps_;

  void add(int code, std::uint32_t value, int if_true = 0, int if_false = 0) {
    steps_.push_back({static_cast<std::uint16_t>(code), static_cast<std::uint8_t>(if_true),
                      static_cast<std::uint8_t>(if_false), value});
  }
  void load(std::size_t offset) {
    add(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset));
  }
  // the lower half: flags, process numbers and modes have no more
  void load_argument(int argument) {
    load(offsetof(seccomp_data, args) + 8 * static_cast<std::size_t>(argument));
  }
  void skip_unless(int number, int steps) {
    add(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(number), 0, steps);
  }
  void finish(std::uint32_t answer) { add(BPF_RET | BPF_K, answer); }
};

// Memory, threads, time, signals to itself, and reading.
constexpr int allowed[] = {
    SYS_read,
    SYS_pread64,
    SYS_readv,
    SYS_preadv,
    SYS_write,
    SYS_writev,
    SYS_close,
    SYS_fstat,
    SYS_newfstatat,
    SYS_statx,
    SYS_lseek,
    SYS_getdents64,
    SYS_readlinkat,
    SYS_faccessat,
    SYS_faccessat2,
    SYS_getcwd,
    SYS_fcntl,
    SYS_dup,
    SYS_dup3,
    SYS_fadvise64,
    SYS_mmap,
    SYS_munmap,
    SYS_mprotect,
    SYS_mremap,
    SYS_madvise,
    SYS_mincore,
    SYS_msync,
    SYS_mlock,
    SYS_munlock,
    SYS_brk,
    SYS_mbind,
    SYS_get_mempolicy,
    SYS_set_mempolicy,
    SYS_membarrier,
    SYS_futex,
    SYS_set_robust_list,
    SYS_get_robust_list,
    SYS_set_tid_address,
    SYS_rseq,
    SYS_sched_yield,
    SYS_sched_getaffinity,
    SYS_sched_setaffinity,
    SYS_sched_getparam,
    SYS_sched_getscheduler,
    SYS_sched_get_priority_max,
    SYS_sched_get_priority_min,
    SYS_getcpu,
    SYS_rt_sigaction,
    SYS_rt_sigprocmask,
    SYS_rt_sigreturn,
    SYS_rt_sigtimedwait,
    SYS_sigaltstack,
    SYS_restart_syscall,
    SYS_nanosleep,
    SYS_clock_nanosleep,
    SYS_clock_gettime,
    SYS_clock_getres,
    SYS_gettimeofday,
    SYS_times,
    SYS_getrusage,
    SYS_sysinfo,
    SYS_uname,
    SYS_getrandom,
    SYS_getpid,
    SYS_getppid,
    SYS_gettid,
    SYS_getuid,
    SYS_geteuid,
    SYS_getgid,
    SYS_getegid,
    SYS_getrlimit,
    SYS_umask,
    SYS_ppoll,
    SYS_pselect6,
    SYS_exit,
    SYS_exit_group,
#if defined(__x86_64__)
    SYS_stat,
    SYS_lstat,
    SYS_access,
    SYS_readlink,
    SYS_getdents,
    SYS_dup2,
    SYS_arch_prctl,
    SYS_poll,
    SYS_select,
    SYS_time,
#endif
};

}  // namespace

bool restrict_this_process() {
  constexpr std::uint32_t writing =
      O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND | (O_TMPFILE & ~O_DIRECTORY);
  Filter filter;
  for (const int number : allowed) filter.allow(number);
  filter.allow_without_bits(SYS_openat, 2, writing, EACCES);
#if defined(__x86_64__)
  filter.allow_without_bits(SYS_open, 1, writing, EACCES);
#endif
  filter.allow_with_bits(SYS_clone, 0, CLONE_THREAD, EPERM);
  filter.allow_with_value(SYS_tgkill, 0, static_cast<std::uint32_t>(getpid()), EPERM);
  filter.allow_with_value(SYS_prlimit64, 2, 0, EPERM);  // to ask for a limit, not to set one
  filter.refuse(SYS_ioctl, ENOTTY);
  filter.refuse(SYS_execve, EACCES);
  filter.refuse(SYS_execveat, EACCES);
  return filter.install();
}

#else

bool restrict_this_process() { return false; }

#endif

}  // namespace langer
