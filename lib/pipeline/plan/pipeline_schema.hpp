// JSON Schema of a pipeline file, from the table of stages and their ports (ports.hpp). Editors use
// it to complete keys and to show errors while a pipeline is written.
#pragma once

#include <string>

namespace langer::pipeline {

std::string pipeline_schema();

}  // namespace langer::pipeline
