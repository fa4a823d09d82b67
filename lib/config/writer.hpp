// Config struct -> canonical YAML text (every key, defaults filled in; equal structs give equal text), and --describe.
//
//   std::string effective = to_yaml(config);
//   std::string reference = describe<SolveConfig>();     // key, type, unit, default, range, meaning
