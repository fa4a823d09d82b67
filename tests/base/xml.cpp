#include "core/base/xml.hpp"

#include <doctest/doctest.h>

using namespace langer;

TEST_CASE("Text in XML is that text for whoever reads it") {
  CHECK(xml_text("a < b && \"c\" > d") == "a &lt; b &amp;&amp; &quot;c&quot; &gt; d");
  CHECK(xml_text("two\nlines\x01") == "two lines ");
  CHECK(xml_text("σ_{xx} 12°") == "σ_{xx} 12°");
}
