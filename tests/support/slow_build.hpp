// Under ASan and UBSan a test takes some 30 times as long: long loops over cases of one kind take
// every eleventh there. 11 has no factor in common with the kinds of a loop (some twenty mutations
// of each value, 1, 2 or 3 contacts): all are met.
#pragma once

namespace langer::test {

#ifdef LANGER_SANITIZE
inline constexpr int stride = 11;
#else
inline constexpr int stride = 1;
#endif

}  // namespace langer::test
