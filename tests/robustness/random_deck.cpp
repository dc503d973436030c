#include "random_deck.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>

#include "core/random.hpp"

namespace polyslip::tests {

namespace {

class Generator {
 public:
  explicit Generator(std::uint64_t seed) : random_(seed, core::Stream::tests), seed_(seed) {}

  RandomDeck make() {
    RandomDeck deck;
    deck.text = polycrystal();
    deck.text += material();
    deck.text += loading();
    deck.text += solver();
    deck.summary = summary_;
    return deck;
  }

 private:
  core::Random random_;
  std::uint64_t seed_;
  std::string summary_;

  bool happens(double probability) { return random_.uniform() < probability; }
  double log_uniform(double low, double high) {
    return low * std::pow(high / low, random_.uniform());
  }
  template <std::size_t n>
  const char* one_of(const std::array<const char*, n>& words) {
    return words[random_.index(n)];
  }

  std::string polycrystal() {
    return fmt::format(
        "[polycrystal]\ngrains = {}\nseed = {}\n[mesh]\nelement_size = {:.2f}\n"
        "meshers = [\"gmsh-hxt\"]\n",
        8 + random_.index(8), seed_, random_.uniform(0.9, 1.2));
  }

  std::string material() {
    struct Metal {
      const char* name;
      double c11, c12, c44, g0;  // MPa
    };
    static constexpr Metal metals[] = {{"Al", 107.3e3, 60.9e3, 28.3e3, 8},
                                       {"Cu", 168.4e3, 121.4e3, 75.4e3, 16},
                                       {"W", 522e3, 204e3, 160.6e3, 300}};
    const Metal& metal = metals[random_.index(3)];
    const double m = log_uniform(0.02, 0.3);
    const bool twelve = happens(0.25);
    summary_ = fmt::format("{} m {:.3f}{}", metal.name, m, twelve ? " twelve g" : "");
    return fmt::format(
        "[material]\nc11 = {}\nc12 = {}\nc44 = {}\nrate_sensitivity = {:.4f}\ng0 = {}\ngs = "
        "{:.3f}\n"
        "h0 = {:.3f}\nvoce_exponent = {:.2f}\nlatent_ratio = {:.2f}\n",
        metal.c11, metal.c12, metal.c44, m, metal.g0, metal.g0 * random_.uniform(1.2, 3.0),
        metal.g0 * log_uniform(0.2, 10), happens(0.5) ? 1.0 : random_.uniform(0.5, 2.5),
        twelve ? random_.uniform(0.5, 1.6) : 1.0);
  }

  std::string loading() {
    const char* type =
        one_of<6>({"plane-strain-compression", "uniaxial-tension", "uniaxial-compression",
                   "simple-shear", "velocity-gradient", "faces"});
    const double rate = log_uniform(1e-6, 1e3);
    const bool reversal = happens(0.5);
    summary_ += fmt::format(" {} rate {:.1e}{}", type, rate, reversal ? " and back" : "");
    std::string text = fmt::format("[loading]\ntype = \"{}\"\nmax_strain_increment = {:.4f}\n",
                                   type, log_uniform(0.005, 0.05));
    const std::string_view kind = type;
    if (kind != "velocity-gradient" && happens(0.3)) text += "control = \"constant-velocity\"\n";
    if (kind == "simple-shear") {
      text +=
          happens(0.5) ? "axis = \"z\"\ndirection = \"x\"\n" : "axis = \"y\"\ndirection = \"z\"\n";
    } else if (kind == "velocity-gradient") {
      text += velocity_gradient();
    } else if (kind == "faces") {
      text += faces(rate);
    } else {
      text += fmt::format("lateral = \"{}\"\n", one_of<3>({"symmetry", "planar", "free"}));
    }
    if (!reversal) return text + fmt::format("strain_rate = {:.6e}\nfinal_strain = 0.15\n", rate);
    text += fmt::format("strain_rate = {:.6e}\n", rate);
    if (kind == "faces" || kind == "velocity-gradient") {
      // without a strain of their own sense: stages by time
      return text + fmt::format(
                        "[[loading.stage]]\nstrain_rate = {0:.6e}\ntime = {1:.6e}\n"
                        "[[loading.stage]]\nstrain_rate = {2:.6e}\ntime = {3:.6e}\n",
                        rate, 0.1 / rate, -rate, 0.15 / rate);
    }
    return text + fmt::format(
                      "[[loading.stage]]\nstrain_rate = {0:.6e}\nstrain = 0.1\n"
                      "[[loading.stage]]\nstrain_rate = {1:.6e}\nstrain = 0.05\n",
                      rate, rate * log_uniform(0.01, 100));
  }

  std::string velocity_gradient() {
    std::array<double, 9> l;
    for (double& entry : l) entry = random_.normal();
    l[8] = -l[0] - l[4];
    std::string text = "velocity_gradient = [";
    for (std::size_t i = 0; i < 9; ++i) text += fmt::format("{}{:.12f}", i > 0 ? ", " : "", l[i]);
    return text + "]\n";
  }

  /// Compression or tension along z; along x flat with a mean traction, or free.
  std::string faces(double rate) {
    std::string text = "x0 = \"sliding\"\ny0 = \"sliding\"\nz0 = \"sliding\"\nz1 = \"sliding\"\n";
    text += fmt::format("z1_velocity = [0, 0, {:.6e}]\n", happens(0.5) ? rate : -rate);
    if (happens(0.5)) text += "y1 = \"sliding\"\n";
    if (happens(0.6))
      text += fmt::format("x1 = \"planar\"\nx1_traction = {:.3f}\n", random_.uniform(-4, 4));
    return text;
  }

  std::string solver() {
    std::string text =
        fmt::format("[solver]\nnewton_tolerance = {:.1e}\n", log_uniform(1e-6, 1e-3));
    const bool to_be_stopped = happens(0.1);
    text += element();
    if (!to_be_stopped) return text;
    summary_ += ", to be stopped";
    return text + "max_newton_iterations = 1\n";
  }

  /// The mixed element with its four points as often as all others together.
  std::string element() {
    if (happens(0.5)) return "";
    const char* kind = one_of<3>({"mixed", "displacement", "displacement-straight"});
    const char* points = one_of<4>({"4", "8", "14", "15"});
    summary_ += fmt::format(", {} with {} points", kind, points);
    return fmt::format("element = \"{}\"\nquadrature_points = {}\n", kind, points);
  }
};

}  // namespace

RandomDeck random_deck(std::uint64_t seed) { return Generator(seed).make(); }

}  // namespace polyslip::tests
