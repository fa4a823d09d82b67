// Tree -> config struct by the struct's listing (base/fields.hpp): the only way a config is read.
// All errors of a file are collected and thrown together as one Failure(config): unknown key (with the nearest known
// one), missing key (at the parent), wrong type, out of range, non-finite number, rules between keys.
//
//   auto [config, where] = read_config<SolveConfig>(load_yaml("solve.yaml"));
//   where("contacts[0].friction")  ->  Place, for errors found later
