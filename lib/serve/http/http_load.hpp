// Loads the module that speaks HTTP (http_interface.hpp).
#pragma once

#include "serve/http/http_interface.hpp"

namespace langer::http {

// Throws Failure(input) with advice where the module is not there: cpp-httplib was missing when
// Langer was configured, or one of its libraries is missing now.
const Functions& load();

}  // namespace langer::http
