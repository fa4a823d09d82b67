version = "0.3.0"  # that of CMakeLists.txt
