// Which files a run may overwrite. It never overwrites a file that it reads, under whatever name it
// is reached; nor a device, FIFO or socket; nor a symbolic link. A file that exists is overwritten
// only if an earlier run made it.
#pragma once

#include <string>

namespace langer {

void never_replace(
    const std::string& path);  // the run reads it: config, input, file that the config names

// throws Failure(input): one of those, a device, FIFO, socket or link
void require_replaceable(const std::string& path);

// For a text next to the main output. An existing one is ours if the main output existed when the
// run began, or if it begins with the same line, as a table does that a killed run has left.
void begin_beside(const std::string& output);
void require_replaceable_by(const std::string& path, const std::string& text);

// For a picture that another program makes from `script`: an existing one is ours if the script
// exists.
void require_replaceable_from(const std::string& path, const std::string& script);

// For a text in any folder: an existing one is ours if it contains `mark`.
void require_own_text(const std::string& path, const std::string& mark);

// For a main output (-o): an existing one is ours if it is HDF5 with our attributes, a report, or
// empty.
void require_own_output(const std::string& path);

// For --log: devices are allowed; an existing file is ours if it begins as our logs do.
void require_own_log(const std::string& path);

}  // namespace langer
