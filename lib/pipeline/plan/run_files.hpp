// The files of a run of a stage: checks that the inputs exist and that the output can be written
// without loss, the identity of the run, and its JSON summary.
//
// The identity (results/store/identity.hpp) is a hash of the effective config and of the content of
// every input file. Two runs with the same identity compute the same thing.
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
#include "results/store/text_result.hpp"

namespace langer {

// The files at each port, in the order given.
using InputFiles = std::map<std::string, std::vector<std::string>>;

// Throws Failure(input) if a file cannot be read. The message names the key that the file is the
// value of.
void require_file(const std::string& path, const Place& named_at = {}, const std::string& key = "");

// Some inputs may be a file at a port or a key of the config; refuses both and neither.
void require_one_source(const StageSpec& stage, const Tree& config,
                        const std::vector<std::string>& ports_given);

// Makes the folder of an output file. Throws Failure(input) if the file cannot be written, or would
// replace an input or a file that no program of Langer made.
void check_output(const std::string& output, const std::string& config, const InputFiles& inputs);

// The files that a config was read from: itself and the files that it includes.
std::set<std::string> files_of(const Tree& tree);

// The files that a mesh file (.inp) includes by *INCLUDE, in all depths. Throws Failure(input) if
// one of them cannot be read.
std::vector<std::string> files_included_by(const std::string& path);

// Content id of an input: from the root attributes of an HDF5 file, from the values (not the
// comments) of a YAML file, from the bytes of any other file.
std::string content_of(const std::string& path);

// The identity of a run. Reads all files that the config names; throws Failure(input) if one of
// them is missing.
Identity identity_of(const std::string& stage, const ConfigText& config, const Where& where,
                     const InputFiles& inputs, const std::string& command);

// One JSON object: stage, config_hash and the results by column name, then those that are words. A
// result that is not finite is null.
std::string json_text(const Identity& identity, const std::vector<Summary>& results,
                      const std::vector<TextResult>& texts = {});

// Applies "key=value" of the command line to a config that was read from a file.
void apply_setting(Tree& config, const std::string& setting);

}  // namespace langer
