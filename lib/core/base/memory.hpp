// Memory of this process and of the machine, in bytes, from Linux's /proc.
#pragma once

namespace langer {

double resident_bytes();  // held now
double peak_bytes();      // most ever held

// Memory that may still be allocated; infinity if nothing is known or nothing limits it.
double free_memory();   // the machine's, or less where the process' group (a cluster's job, a
                        // container) has a limit
double free_address();  // under the shell's ulimit -v

}  // namespace langer
