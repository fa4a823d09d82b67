// Memory of this process and of the machine, in bytes; Linux tells it in /proc.
#pragma once

namespace langer {

double resident_bytes();  // held now
double peak_bytes();      // most ever held

// What may still be taken; infinity where nothing is known or nothing limits it.
double free_memory();   // the machine's, or less where the process' group (a cluster's job, a
                        // container) has a limit
double free_address();  // under the shell's ulimit -v

}  // namespace langer
