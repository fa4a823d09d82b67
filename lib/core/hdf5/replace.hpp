// What a run may write over. Files that it reads are never replaced by what it makes, under
// whatever name they are reached; nor is what is no plain file (device, FIFO, socket), nor a
// symbolic link, whose target would stay as it is while the name changes its meaning.
#pragma once

#include <string>

namespace langer {

void never_replace(
    const std::string& path);  // the run reads it: config, input, file that the config names

// throws Failure(input): one of those, a device, FIFO, socket or link
void require_replaceable(const std::string& path);

// Of a text beside the main output. One that is there is ours if the main output was there when the
// run began, or if it begins with the same line: as a table with the same columns does, which a run
// that was killed left behind.
void begin_beside(const std::string& output);
void require_replaceable_by(const std::string& path, const std::string& text);

// The same of a file that another program makes from `script`, a picture: it is ours if the script
// is there.
void require_replaceable_from(const std::string& path, const std::string& script);

// The same of a text, wherever it stands: one that is there has `mark` in it.
void require_own_text(const std::string& path, const std::string& mark);

// The same of a main output (-o), and that a file that is there was made by langer: HDF5 with our
// attributes, a report, or nothing in it.
void require_own_output(const std::string& path);

// The same of a file for --log; devices may be written to. One that is there begins as our logs do.
void require_own_log(const std::string& path);

}  // namespace langer
