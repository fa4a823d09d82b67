version = "0.2.0"  # that of CMakeLists.txt
