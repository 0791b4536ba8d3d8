// Two hundred shows that are killed.
#include "app/crash.h"

namespace limber::app_test {
namespace {

TEST(LongCrash, TwoHundredKilledShows) { crash(200, 8); }

}  // namespace
}  // namespace limber::app_test
