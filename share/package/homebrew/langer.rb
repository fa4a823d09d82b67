# brew install --build-from-source ./share/package/homebrew/langer.rb   (set url and sha256 to those of a release first)
class Langer < Formula
  desc "Mechanics of skin and other fibrous soft tissue"
  homepage "https://example.org/langer"
  url "https://example.org/langer/archive/v0.4.0.tar.gz"
  sha256 "0000000000000000000000000000000000000000000000000000000000000000"
  license "MIT"

  depends_on "boost" => :build
  depends_on "cli11" => :build
  depends_on "cmake" => :build
  depends_on "eigen" => :build
  depends_on "ninja" => :build
  depends_on "nlohmann-json" => :build
  depends_on "pkgconf" => :build
  depends_on "fmt"
  depends_on "gmsh"
  depends_on "gnuplot"
  depends_on "hdf5"
  depends_on :linux
  depends_on "muparser"
  depends_on "nlopt"
  depends_on "openblas"
  depends_on "suite-sparse"
  depends_on "sundials"
  depends_on "yaml-cpp"

  def install
    system "cmake", "-S", ".", "-B", "build", "-G", "Ninja",
           "-DLANGER_NATIVE=OFF", "-DLANGER_TESTS=OFF", *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
  end

  test do
    system bin/"langer", "doctor"
    system bin/"langer", "new", "tension", "skin"
    system "make", "-C", "skin"
  end
end
