// What a run does with its files before and after the work: inputs are there, the output can be
// written, who made what.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/config/reader.hpp"
#include "core/config/writer.hpp"
#include "core/hdf5/replace.hpp"
#include "pipeline/plan/ports.hpp"
#include "results/store/identity.hpp"
#include "results/store/provenance.hpp"

namespace langer {

using InputFiles =
    std::map<std::string, std::vector<std::string>>;  // port -> files in the order given

void need_file(const std::string& path, const Place& named_at = {},
               const std::string& key = "");  // throws Failure(input)

// What a config may hold in place of a file at a port: refuses both and neither.
void need_one_source(const StageSpec& stage, const Tree& config,
                     const std::vector<std::string>& ports_given);

// Makes the folder of an output file; throws Failure(input) where it cannot be written, or would
// replace an input or what is not ours.
void need_output(const std::string& output, const std::string& config, const InputFiles& inputs);

std::set<std::string> files_of(
    const Tree& tree);  // that its parts were read from: the config itself and what it includes

// Files that a file reads itself: those that *INCLUDE names in an .inp, in all depths. Throws
// Failure(input) where one of them cannot be read.
std::vector<std::string> files_included_by(const std::string& path);

// Content id of an input: from the root attributes of an HDF5 file, from the values (not the
// comments) of a YAML file, from the bytes of any other file.
std::string content_of(const std::string& path);

// Reads what the config names. Throws Failure(input) where such a file is missing.
Identity identity_of(const std::string& stage, const ConfigText& config, const Where& where,
                     const InputFiles& inputs, const std::string& command);

// one JSON object: stage, config_hash and the results by column name (null where not finite)
std::string json_text(const Identity& identity, const std::vector<Summary>& results);

// "key=value" of the command line, applied to a config that was read from a file
void apply_setting(Tree& config, const std::string& setting);

}  // namespace langer
