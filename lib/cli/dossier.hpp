// The evidence for a run as one document, in the order of ASME V&V 40-2018 (Assessing Credibility
// of Computational Modeling through Verification and Validation: Application to Medical Devices):
// question and context of use, code verification, calculation verification, validation, and where
// the model applies. Every number is read from the files of the run. What they do not hold is named
// as missing, with the command that makes it. The grades of credibility are the reader's.
#pragma once

#include <string>

namespace langer {

// What no file of a run says.
struct DossierWords {
  std::string use;       // context of use: what is decided by the model, for whom, in which range
  std::string question;  // question of interest
  std::string risk;      // of a wrong decision, and the share that the model has in it
  std::string tests;     // log of ctest, build/Testing/Temporary/LastTest.log; empty: none
};

enum class DossierFormat { markdown, html };

// Throws Failure(input) if the folder has no Makefile of langer-plan, or if the log is no log of
// ctest.
std::string dossier_text(const std::string& folder, const DossierWords& words,
                         DossierFormat format);

}  // namespace langer
