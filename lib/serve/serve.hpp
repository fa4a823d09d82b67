// `langer serve`: a local page on which a scene is set up, checked, drawn, run and read, for people
// who do not write YAML. docs/serve.md
//
//   browser --HTTP--> serve.cpp      who may ask: token, Host, size
//                     project_api    what may be asked
//                     folder         which files may be read and written
//                     child          which programs run
//
// The server listens on 127.0.0.1 only. Its address has a random token of 128 bits, which every
// request needs: other users of the machine and other pages of the browser do not know it. The
// Host header must be the server's own, so that no other name can be made to point to it (DNS
// rebinding). Everything that the page does is in files that `make` runs without it.
#pragma once

#include <string>

namespace langer {

// Serves until SIGINT or SIGTERM; prints the address to stdout. Returns the exit code. `port` 0: a
// free one. Throws Failure.
int serve(const std::string& folder, int port);

}  // namespace langer
