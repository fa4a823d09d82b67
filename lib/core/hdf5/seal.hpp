// The seal of a finished file: one line of ASCII behind HDF5's last byte with a checksum of
// everything before it. HDF5 1.10 may crash on damaged metadata, so a damaged file must be known as
// such before HDF5 sees it. HDF5 ignores the line; a tool that edits the file cuts it off, and a
// file without seal is read on trust.
#pragma once

#include <string>

namespace langer {

void append_seal(const std::string& path);  // and forces the file to the disk
enum class Seal { none, whole, broken };    // broken: it is there and does not fit
Seal seal_of(const std::string& path);
void rename_durably(const std::string& from, const std::string& to);
void sync_folder_of(const std::string& path);  // that the name of a new file lasts
void write_text_file(const std::string& path, const std::string& text);  // through <path>.part
// As write_text_file, without waiting for the disk: for the many small files that the same command
// makes again at any time.
void write_text_file_soon(const std::string& path, const std::string& text);
// Replaces a file, whatever it held, without waiting for the disk: pictures whose places were
// looked at before.
void replace_file(const std::string& path, const std::string& bytes);

}  // namespace langer
