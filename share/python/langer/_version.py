version = "0.4.0"  # that of CMakeLists.txt
