/* The interface FMI 3.0 of a bearing: Model Exchange and Co-Simulation. All of it follows from the values of now: there
 * are no clocks and no events, and continuous states where films have a memory. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "component.h"
#include "fmi3Functions.h"

typedef struct instance {
    component *of;
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log;
    int told; /* the last status that was logged */
} instance;

typedef fmi3ValueReference reference;

static void log_text(const instance *self, fmi3Status status, const char *category, const char *text) {
    if (self->log) self->log(self->environment, status, category, text);
}

static fmi3Status refuse(const instance *self, const char *text) {
    log_text(self, fmi3Error, "logStatusError", text);
    return fmi3Error;
}

/* What a status of the law is here. What is refused is always logged, what is held at the edge once in a row. */
static fmi3Status judged(instance *self, int status) {
    char text[512];
    const fmi3Status found = EHD_REFUSES(status) ? fmi3Discard : status ? fmi3Warning : fmi3OK;
    if (found == fmi3Discard || (status && status != self->told)) {
        component_message(self->of, status, text, sizeof text);
        log_text(self, found, found == fmi3Discard ? "logStatusDiscard" : "logStatusWarning", text);
    }
    self->told = status;
    return found;
}

const char *fmi3GetVersion(void) { return fmi3Version; }

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t count, const fmi3String categories[]) {
    (void)c, (void)on, (void)count, (void)categories;
    return fmi3OK;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                          fmi3Boolean logging, fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback log) {
    instance *self = calloc(1, sizeof *self);
    (void)name, (void)resources, (void)visible, (void)logging;
    if (!self) return NULL;
    self->environment = environment;
    self->log = log;
    if (!token || strcmp(token, FMU_TOKEN) != 0)
        refuse(self, "the token is not that of this FMU: model description and binary do not belong together");
    else
        self->of = component_make();
    if (self->of) return self;
    fmi3FreeInstance(self);
    return NULL;
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                         fmi3Boolean logging, fmi3Boolean events, fmi3Boolean early,
                                         const reference required[], size_t count, fmi3InstanceEnvironment environment,
                                         fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update) {
    (void)events, (void)early, (void)required, (void)count, (void)update;
    return fmi3InstantiateModelExchange(name, token, resources, visible, logging, environment, log);
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resources,
                                               fmi3Boolean visible, fmi3Boolean logging,
                                               fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
                                               fmi3ClockUpdateCallback update, fmi3LockPreemptionCallback lock,
                                               fmi3UnlockPreemptionCallback unlock) {
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)update, (void)lock, (void)unlock;
    if (log) log(environment, fmi3Error, "logStatusError", "there is no scheduled execution");
    return NULL;
}

void fmi3FreeInstance(fmi3Instance c) {
    instance *self = c;
    if (!self) return;
    free(self->of);
    free(self);
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean tolerant, fmi3Float64 tolerance, fmi3Float64 start,
                                       fmi3Boolean stops, fmi3Float64 stop) {
    (void)tolerant, (void)tolerance, (void)stops, (void)stop;
    ((instance *)c)->of->now.values[TIME] = start;
    return fmi3OK;
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c) { return judged(c, component_begin(((instance *)c)->of)); }

fmi3Status fmi3EnterEventMode(fmi3Instance c) { return (void)c, fmi3OK; }

fmi3Status fmi3Terminate(fmi3Instance c) { return (void)c, fmi3OK; }

fmi3Status fmi3Reset(fmi3Instance c) {
    component_reset(((instance *)c)->of);
    return fmi3OK;
}

fmi3Status fmi3GetFloat64(fmi3Instance c, const reference references[], size_t count, fmi3Float64 values[],
                          size_t size) {
    instance *self = c;
    fmi3Status status = fmi3OK;
    if (count != size) return refuse(self, "as many values as references are wanted: all variables are scalars");
    for (size_t i = 0; i < count; i++) {
        if (references[i] >= FIRST_OUTPUT && self->of->stale) status = judged(self, component_update(self->of));
        if (!component_get(self->of, references[i], &values[i])) return refuse(self, "no variable has this reference");
        if (isnan(values[i])) status = fmi3Discard;
    }
    return status;
}

fmi3Status fmi3SetFloat64(fmi3Instance c, const reference references[], size_t count, const fmi3Float64 values[],
                          size_t size) {
    instance *self = c;
    if (count != size) return refuse(self, "as many values as references are wanted: all variables are scalars");
    for (size_t i = 0; i < count; i++)
        if (!component_set(self->of, references[i], values[i]))
            return refuse(self, "a value that is not finite, or a variable that cannot be set");
    return fmi3OK;
}

/* There are variables of one type only. */
static fmi3Status none(fmi3Instance c, size_t count) {
    return count ? refuse(c, "there are variables of the type Float64 only") : fmi3OK;
}

#define NONE(Type)                                                                                                     \
    fmi3Status fmi3Get##Type(fmi3Instance c, const reference r[], size_t n, fmi3##Type v[], size_t size) {             \
        return (void)r, (void)v, (void)size, none(c, n);                                                               \
    }                                                                                                                  \
    fmi3Status fmi3Set##Type(fmi3Instance c, const reference r[], size_t n, const fmi3##Type v[], size_t size) {       \
        return (void)r, (void)v, (void)size, none(c, n);                                                               \
    }
NONE(Float32)
NONE(Int8)
NONE(UInt8)
NONE(Int16)
NONE(UInt16)
NONE(Int32)
NONE(UInt32)
NONE(Int64)
NONE(UInt64)
NONE(Boolean)
NONE(String)

fmi3Status fmi3GetBinary(fmi3Instance c, const reference r[], size_t n, size_t sizes[], fmi3Binary v[], size_t size) {
    return (void)r, (void)sizes, (void)v, (void)size, none(c, n);
}

fmi3Status fmi3SetBinary(fmi3Instance c, const reference r[], size_t n, const size_t sizes[], const fmi3Binary v[],
                         size_t size) {
    return (void)r, (void)sizes, (void)v, (void)size, none(c, n);
}

fmi3Status fmi3GetClock(fmi3Instance c, const reference r[], size_t n, fmi3Clock v[]) {
    return (void)r, (void)v, none(c, n);
}

fmi3Status fmi3SetClock(fmi3Instance c, const reference r[], size_t n, const fmi3Clock v[]) {
    return (void)r, (void)v, none(c, n);
}

/* Every output depends on every input and parameter, and on every state; a rate on inputs and on its own state. */

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance c, reference variable, size_t *count) {
    const size_t states = variable >= FIRST_RATE ? 1 : FILMS;
    (void)c;
    *count = component_is_unknown(variable) ? FIRST_OUTPUT - FIRST_INPUT + states : 0;
    return fmi3OK;
}

fmi3Status fmi3GetVariableDependencies(fmi3Instance c, reference variable, size_t own[], reference others[],
                                       size_t theirs[], fmi3DependencyKind kinds[], size_t count) {
    const size_t inputs = FIRST_OUTPUT - FIRST_INPUT;
    const reference state = variable >= FIRST_RATE ? variable - FILMS : FIRST_STATE;
    size_t known = 0;
    fmi3GetNumberOfVariableDependencies(c, variable, &known);
    if (count != known) return refuse(c, "another number of dependencies than there are");
    for (size_t i = 0; i < count; i++) {
        own[i] = theirs[i] = 0;
        others[i] = i < inputs ? (reference)(FIRST_INPUT + i) : (reference)(state + i - inputs);
        kinds[i] = fmi3Dependent;
    }
    return fmi3OK;
}

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state) {
    instance *self = c;
    if (!state) return refuse(self, "no state is given");
    if (!*state) *state = calloc(1, sizeof self->of->now);
    if (!*state) return refuse(self, "no memory");
    memcpy(*state, &self->of->now, sizeof self->of->now);
    return fmi3OK;
}

fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state) {
    instance *self = c;
    if (!state) return refuse(self, "no state is given");
    component_restore(self->of, state);
    return fmi3OK;
}

fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state) {
    (void)c;
    if (!state) return fmi3OK; /* as free has it, says the standard */
    free(*state);
    *state = NULL;
    return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t *size) {
    if (!state || !size) return refuse(c, "no state is given");
    *size = sizeof((instance *)c)->of->now;
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size) {
    instance *self = c;
    if (!state || !bytes) return refuse(self, "no state is given");
    if (size < sizeof self->of->now) return refuse(self, "too little room for a state");
    memcpy(bytes, state, sizeof self->of->now);
    return fmi3OK;
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState *state) {
    instance *self = c;
    if (!state || !bytes) return refuse(self, "no state is given");
    if (size != sizeof self->of->now) return refuse(self, "no state of this FMU");
    if (!*state) *state = calloc(1, size);
    if (!*state) return refuse(self, "no memory");
    memcpy(*state, bytes, size);
    return fmi3OK;
}

/* Sum over the knowns for each unknown, or over the unknowns for each known. */
static fmi3Status derivatives(instance *self, const reference unknowns[], size_t unknown_count,
                              const reference knowns[], size_t known_count, const fmi3Float64 seeds[], int adjoint,
                              fmi3Float64 found[]) {
    fmi3Status status = fmi3OK;
    for (size_t j = 0; j < known_count; j++)
        if (!IS_KNOWN(knowns[j])) return refuse(self, "derivative by neither input, parameter nor state");
    memset(found, 0, (adjoint ? known_count : unknown_count) * sizeof *found);
    for (size_t i = 0; i < unknown_count; i++) {
        if (!component_is_unknown(unknowns[i])) return refuse(self, "derivative of neither output nor rate");
        for (size_t j = 0; j < known_count; j++) {
            double derivative;
            if (seeds[adjoint ? i : j] == 0.0) continue;
            const int code = component_derivative(self->of, unknowns[i], knowns[j], &derivative);
            if (EHD_REFUSES(code)) return judged(self, code);
            if (code) status = fmi3Warning;
            found[adjoint ? j : i] += derivative * seeds[adjoint ? i : j];
        }
    }
    return status;
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const reference unknowns[], size_t unknown_count,
                                        const reference knowns[], size_t known_count, const fmi3Float64 seeds[],
                                        size_t seed_count, fmi3Float64 found[], size_t found_count) {
    if (seed_count != known_count || found_count != unknown_count) return refuse(c, "numbers that do not fit");
    return derivatives(c, unknowns, unknown_count, knowns, known_count, seeds, 0, found);
}

fmi3Status fmi3GetAdjointDerivative(fmi3Instance c, const reference unknowns[], size_t unknown_count,
                                    const reference knowns[], size_t known_count, const fmi3Float64 seeds[],
                                    size_t seed_count, fmi3Float64 found[], size_t found_count) {
    if (seed_count != unknown_count || found_count != known_count) return refuse(c, "numbers that do not fit");
    return derivatives(c, unknowns, unknown_count, knowns, known_count, seeds, 1, found);
}

fmi3Status fmi3EnterConfigurationMode(fmi3Instance c) { return (void)c, fmi3OK; }

fmi3Status fmi3ExitConfigurationMode(fmi3Instance c) { return (void)c, fmi3OK; }

/* There are no clocks. */

fmi3Status fmi3GetIntervalDecimal(fmi3Instance c, const reference r[], size_t n, fmi3Float64 v[],
                                  fmi3IntervalQualifier q[]) {
    return (void)r, (void)v, (void)q, none(c, n);
}

fmi3Status fmi3GetIntervalFraction(fmi3Instance c, const reference r[], size_t n, fmi3UInt64 v[], fmi3UInt64 d[],
                                   fmi3IntervalQualifier q[]) {
    return (void)r, (void)v, (void)d, (void)q, none(c, n);
}

fmi3Status fmi3GetShiftDecimal(fmi3Instance c, const reference r[], size_t n, fmi3Float64 v[]) {
    return (void)r, (void)v, none(c, n);
}

fmi3Status fmi3GetShiftFraction(fmi3Instance c, const reference r[], size_t n, fmi3UInt64 v[], fmi3UInt64 d[]) {
    return (void)r, (void)v, (void)d, none(c, n);
}

fmi3Status fmi3SetIntervalDecimal(fmi3Instance c, const reference r[], size_t n, const fmi3Float64 v[]) {
    return (void)r, (void)v, none(c, n);
}

fmi3Status fmi3SetIntervalFraction(fmi3Instance c, const reference r[], size_t n, const fmi3UInt64 v[],
                                   const fmi3UInt64 d[]) {
    return (void)r, (void)v, (void)d, none(c, n);
}

fmi3Status fmi3SetShiftDecimal(fmi3Instance c, const reference r[], size_t n, const fmi3Float64 v[]) {
    return (void)r, (void)v, none(c, n);
}

fmi3Status fmi3SetShiftFraction(fmi3Instance c, const reference r[], size_t n, const fmi3UInt64 v[],
                                const fmi3UInt64 d[]) {
    return (void)r, (void)v, (void)d, none(c, n);
}

fmi3Status fmi3ActivateModelPartition(fmi3Instance c, reference clock, fmi3Float64 time) {
    return (void)clock, (void)time, none(c, 1);
}

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance c) { return (void)c, fmi3OK; }

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *again, fmi3Boolean *end, fmi3Boolean *nominals,
                                    fmi3Boolean *states, fmi3Boolean *planned, fmi3Float64 *next) {
    (void)c;
    *again = *end = *nominals = *states = *planned = fmi3False;
    *next = 0.0;
    return fmi3OK;
}

/* Model Exchange. */

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c) { return (void)c, fmi3OK; }

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean keeps, fmi3Boolean *event, fmi3Boolean *end) {
    (void)c, (void)keeps;
    *event = *end = fmi3False;
    return fmi3OK;
}

fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 time) {
    ((instance *)c)->of->now.values[TIME] = time;
    return fmi3OK;
}

fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64 x[], size_t n) {
    (void)x;
    return n ? refuse(c, "there are no event indicators") : fmi3OK;
}

/* States of films, and their rates: none without memory. Solvers try states far from where they end: loads above the
 * map refuse forces, but no rates. */

static const char WRONG_COUNT[] = "another number of continuous states than there are";

fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 x[], size_t n) {
    instance *self = c;
    if (n != FILMS) return refuse(self, WRONG_COUNT);
    for (size_t i = 0; i < n; i++)
        if (!component_set(self->of, FIRST_STATE + (unsigned)i, x[i])) return refuse(self, "a state that is not finite");
    return fmi3OK;
}

static fmi3Status get_all(instance *self, unsigned first, fmi3Float64 x[], size_t n) {
    if (n != FILMS) return refuse(self, WRONG_COUNT);
    const fmi3Status status = n ? judged(self, component_update(self->of) & ~EHD_ABOVE_LOAD) : fmi3OK;
    for (size_t i = 0; i < n; i++) component_get(self->of, first + (unsigned)i, &x[i]);
    return status;
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 x[], size_t n) { return get_all(c, FIRST_RATE, x, n); }

fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 x[], size_t n) { return get_all(c, FIRST_STATE, x, n); }

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 x[], size_t n) {
    if (n != FILMS) return refuse(c, WRONG_COUNT);
    for (size_t i = 0; i < n; i++) x[i] = NOMINAL_STATE;
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t *n) { return (void)c, *n = 0, fmi3OK; }

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t *n) { return (void)c, *n = FILMS, fmi3OK; }

/* Co-Simulation: the inputs that are set before a step are those of its end, and so is the force, which the importer
 * holds until the next one. */

fmi3Status fmi3EnterStepMode(fmi3Instance c) { return (void)c, fmi3OK; }

fmi3Status fmi3GetOutputDerivatives(fmi3Instance c, const reference r[], size_t n, const fmi3Int32 orders[],
                                    fmi3Float64 v[], size_t size) {
    (void)r, (void)orders, (void)v, (void)size;
    return n ? refuse(c, "outputs have no derivatives by time") : fmi3OK;
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 now, fmi3Float64 step, fmi3Boolean keeps, fmi3Boolean *event,
                      fmi3Boolean *end, fmi3Boolean *early, fmi3Float64 *last) {
    instance *self = c;
    (void)keeps;
    *event = *end = *early = fmi3False;
    *last = now;
    if (!(isfinite(now) && isfinite(step) && step >= 0.0)) return refuse(self, "a step that is not finite and >= 0 s");
    const fmi3Status status = judged(self, component_step(self->of, step));
    if (status != fmi3Discard) *last = self->of->now.values[TIME] = now + step;
    return status;
}
