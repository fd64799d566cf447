// SPDX-License-Identifier: Apache-2.0
// The oracle: a slow, simple interpreter of IR in double precision. Points run in lock step with
// masks, as the language defines it; lights, spaces and messages come from the caller. Nothing here
// is shared with emitted code or its library.
#pragma once

#include "slc/interp_value.h"
#include "slc/ir.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace slc {

struct LightSample {
    Triple3 L{0, 0, 0}; // from the point to the light
    Triple3 Cl{0, 0, 0};
    Triple3 Ol{1, 1, 1};
    double nondiffuse = 0, nonspecular = 0;
};

// One ray, or cone of rays, as sl_ray_query describes it.
struct RayQuestion {
    int kind = 0; // SL_RAYS_*
    Triple3 P{0, 0, 0}, D{0, 0, 0};
    Triple3 P_u{0, 0, 0}, P_v{0, 0, 0}, D_u{0, 0, 0}, D_v{0, 0, 0};
    double angle = 0; // gather
    int sample = 0;
    std::string category;
    std::map<std::string, Value> options; // name/value pairs
    std::map<std::string, Type> wanted;   // pairs that set a variable
};

struct RayAnswer {
    bool hit = false;
    Triple3 C{0, 0, 0};
    double distance = 0;
    Triple3 Phit{0, 0, 0}, Nhit{0, 0, 0}, Pmiss{0, 0, 0}, Rmiss{0, 0, 0};
    double level_missed = 0;
    std::map<std::string, Value> found; // of what is wanted
};

// The engine as the interpreter sees it. Every method has a default, so that a test overrides what
// it needs.
class InterpHost {
public:
    virtual ~InterpHost() = default;
    [[nodiscard]] virtual int num_lights() { return 0; }
    // False if the light does not reach P at this point. cos_angle <= -1: all directions (axis
    // unused).
    virtual bool light(int index, int point, const Triple3& P, const Triple3& axis,
                       double cos_angle, const std::string& category, LightSample& sample);
    // By default nothing is hit and nothing is in the way.
    virtual void rays(int point, const RayQuestion& question, RayAnswer& answer);
    virtual Triple3 ambient(int point, const Triple3& P);
    // Row-vector matrix; false if a space is unknown (identity is used).
    virtual bool space(const std::string& from, const std::string& to, int point, Matrix16& m);
    // `function` is the name of the built-in ("surface", "attribute" ...). True if value was set.
    virtual bool message(std::string_view function, const std::string& name, int point,
                         Value& value);
    // A function of a DSO: "name signature"; values are outputs, to be set, then inputs.
    virtual void shadeop(const std::string& function, int point, std::vector<Value>& values,
                         std::size_t num_outputs);
    virtual void print(const std::string& text);
    virtual std::uint32_t seed(int point) { return static_cast<std::uint32_t>(point); }
    virtual void depth_range(double& near_z, double& far_z);
    virtual int raylevel() { return 0; }
    virtual std::string shader_name(const std::string& type) { return type.empty() ? "test" : ""; }
    // Neighbours of a point at u + du and v + dv, or -1: then derivatives are 0 and
    // calculatenormal() gives N.
    virtual void neighbours(int point, int& at_u, int& at_v);
};

// Decides instead of a program that runs on one point: for evaluating it where another point went.
class InterpDirector {
public:
    virtual ~InterpDirector() = default;
    // Whether an If or a Loop in its round-th round is taken.
    virtual bool decide(const Stmt& s, int round, bool natural) = 0;
    virtual void enter(const Stmt& s, int body, int round) = 0;
    // True: what has happened since enter() did not, because of a jump that was not allowed.
    virtual bool leave() = 0;
    virtual bool may_jump(const Stmt& s) = 0;
    // The value of a call, if it is known otherwise.
    virtual bool replace(const Stmt& s, const std::vector<Value>& args, Value& result) = 0;
    virtual void computed(const Stmt& s, const std::vector<Value>& args, const Value& result) = 0;
    // Arguments an area operator has at auxiliary point 1 or 2.
    virtual const std::vector<Value>& arguments_at(const Stmt& s, int aux) = 0;
};

class Interpreter {
public:
    Interpreter(const Program& program, InterpHost& host, int num_points);

    // Values before the run; unset variables are zero.
    void set_global(int variable, int point, const Value& value);
    // Its difference at an auxiliary point (1: u, 2: v).
    void set_aux(int variable, int aux, int point, const Value& value);
    void set_param(std::string_view name, int point, const Value& value); // instead of its default
    // The difference of the parameter that is variable `id`, where the program reads it.
    void set_param_aux(VarId id, int aux, int point, const Value& value);
    void direct(InterpDirector* director) { director_ = director; } // with one point only
    void stop() { steps_ = max_steps_; }
    // Evaluates the defaults of parameters that were not set, then the body. False: stopped, it did
    // not end.
    bool run();
    // Statements times points until run() gives up.
    void limit_steps(std::size_t most) { max_steps_ = most; }
    // Values that are no floats are rounded up or down at random from now on, results of built-ins
    // by a few places more: the spread over some seeds shows what float arithmetic makes of a
    // program ([Vignes93] CESTAC).
    void round_at_random(std::uint32_t seed) { rounding_ = seed | 1; }
    // While rounding, something at that point was no number, or beyond what float arithmetic treats
    // alike everywhere (arguments of sin() and the like): what follows from it is not defined.
    [[nodiscard]] bool left_numbers(int point) const {
        return wild_[static_cast<std::size_t>(point)] != 0;
    }

    [[nodiscard]] const Value& global(int variable, int point) const;
    [[nodiscard]] const Value& aux(int variable, int aux, int point) const;
    [[nodiscard]] const Value& param(std::string_view name, int point) const;
    [[nodiscard]] const Value& value(VarId id, int point) const { return at(id, point); }
    // Light shaders: the point was in the cone of an illuminate or solar.
    [[nodiscard]] bool lit(int point) const { return lit_[static_cast<std::size_t>(point)] != 0; }

private:
    using Mask = std::vector<char>;
    struct Frame { // Loop, Illuminance or Scope around the current statement
        bool is_loop = false;
        Mask left;      // points that broke out or returned
        Mask continued; // points that wait for the next round
    };
    [[nodiscard]] std::size_t find(std::string_view name) const;
    void block(const Block& b, Mask& mask);
    void statement(const Stmt& s, Mask& mask);
    void element(const Stmt& s, int point);
    void operation(const Stmt& s, int point);
    void arithmetic(const Stmt& s, int point);
    void matrix_arithmetic(const Stmt& s, int point);
    void compare(const Stmt& s, int point);
    void copy(const Stmt& s, int point);
    void branch(const Stmt& s, Mask& mask);
    void directed_branch(const Stmt& s, Mask& mask);
    void part(const Stmt& s, int body, int round, Mask& mask);
    void loop(const Stmt& s, Mask& mask);
    void jump(const Stmt& s, Mask& mask);
    void scope(const Stmt& s, Mask& mask);
    void illuminance(const Stmt& s, Mask& mask);
    void light_body(const Stmt& s, int light, const Mask& mask, Mask& running);
    void illuminate(const Stmt& s, Mask& mask);
    bool emit_direction(const Stmt& s, int point, Triple3& L);
    void round(const Stmt& s, const Mask& mask);

    // interp_call.cpp
    void call(const Stmt& s, const Mask& mask);
    void row_difference(const Stmt& s, const Mask& mask, int point);
    void call_at(const Stmt& s, const Mask& mask, int point);
    bool lighting(const Stmt& s, int point, Value& result);
    bool state(const Stmt& s, int point, std::vector<Value>& args, Value& result);
    bool spaces(const Stmt& s, int point, const std::vector<Value>& args, Value& result);
    bool area(const Stmt& s, const Mask& mask, int point, Value& result);
    Triple3 oriented_normal(int point, const Triple3& p_u, const Triple3& p_v) const;
    bool text(const Stmt& s, int point, Value& result);
    bool shadeop(const Stmt& s, int point, std::vector<Value>& args);
    bool rays(const Stmt& s, int point, std::vector<Value>& args, Value& result); // interp_rays.cpp
    void random(int point, bool is_uniform, Value& result);
    void fallback(const Stmt& s, int point, Value& result);
    Triple3 illuminate_sum(const Stmt& s, int point);
    Value difference(const Stmt& s, std::size_t arg, int point, int aux, int neighbour) const;

    Value& at(VarId id, int point);
    [[nodiscard]] const Value& at(VarId id, int point) const;
    [[nodiscard]] Triple3 global3(int variable, int point) const;
    [[nodiscard]] const Var& var(VarId id) const {
        return program_.vars[static_cast<std::size_t>(id)];
    }

    Mask wild_;                  // left_numbers()
    std::uint32_t rounding_ = 0; // state of its random numbers; 0: double precision
    std::size_t max_steps_ = 20'000'000;

    const Program& program_;
    InterpHost& host_;
    InterpDirector* director_ = nullptr;
    int num_points_;
    std::vector<std::vector<Value>> values_;   // by variable, by point
    std::vector<std::vector<Value>> globals_;  // by aux * SL_VAR_COUNT + sl_variable, by point
    std::vector<char> bound_;                  // parameters that were set
    std::vector<std::uint32_t> random_counts_; // by point
    std::vector<std::uint32_t> random_uniform_counts_; // calls with a uniform target, by point
    int light_loops_ = 0; // illuminance statements around the current one
    Mask lit_;
    std::vector<Frame> frames_;
    std::size_t steps_ = 0;
};

} // namespace slc
