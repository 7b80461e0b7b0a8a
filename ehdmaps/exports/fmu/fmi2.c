/* The interface FMI 2.0 of a bearing: Model Exchange and Co-Simulation. All of it follows from the values of now: there
 * are no events, and continuous states where films have a memory. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "component.h"
#include "fmi2Functions.h"

typedef struct instance {
    component *of;
    const fmi2CallbackFunctions *functions;
    char *name;
    fmi2Boolean logging;
    int told; /* the last status that was logged */
} instance;

/* No text here has a % in it, so that it may stand as the format: importers that do not format see it too. */
static void log_text(const instance *self, fmi2Status status, const char *category, const char *text) {
    if (self->functions && self->functions->logger)
        self->functions->logger(self->functions->componentEnvironment, self->name, status, category, text);
}

static fmi2Status refuse(const instance *self, const char *text) {
    log_text(self, fmi2Error, "logStatusError", text);
    return fmi2Error;
}

/* What a status of the law is here. What is refused is always logged, what is held at the edge once in a row. */
static fmi2Status judged(instance *self, int status) {
    char text[512];
    const fmi2Status found = EHD_REFUSES(status) ? fmi2Discard : status ? fmi2Warning : fmi2OK;
    if (found == fmi2Discard || (status && status != self->told)) {
        component_message(self->of, status, text, sizeof text);
        log_text(self, found, found == fmi2Discard ? "logStatusDiscard" : "logStatusWarning", text);
    }
    self->told = status;
    return found;
}

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

const char *fmi2GetVersion(void) { return fmi2Version; }

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t count, const fmi2String categories[]) {
    (void)count, (void)categories;
    ((instance *)c)->logging = on;
    return fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging) {
    instance *self = calloc(1, sizeof *self);
    (void)type, (void)resources, (void)visible;
    if (!self) return NULL;
    self->functions = functions;
    self->logging = logging;
    self->name = calloc(1, (name ? strlen(name) : 0) + 1);
    if (self->name && name) strcpy(self->name, name);
    if (!guid || strcmp(guid, FMU_TOKEN) != 0)
        refuse(self, "the guid is not that of this FMU: model description and binary do not belong together");
    else
        self->of = component_make();
    if (self->of && self->name) return self;
    fmi2FreeInstance(self);
    return NULL;
}

void fmi2FreeInstance(fmi2Component c) {
    instance *self = c;
    if (!self) return;
    free(self->of);
    free(self->name);
    free(self);
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerant, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean stops, fmi2Real stop) {
    (void)tolerant, (void)tolerance, (void)stops, (void)stop;
    ((instance *)c)->of->now.values[TIME] = start;
    return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return (void)c, fmi2OK; }

fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return judged(c, component_begin(((instance *)c)->of)); }

fmi2Status fmi2Terminate(fmi2Component c) { return (void)c, fmi2OK; }

fmi2Status fmi2Reset(fmi2Component c) {
    component_reset(((instance *)c)->of);
    return fmi2OK;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference references[], size_t count, fmi2Real values[]) {
    instance *self = c;
    fmi2Status status = fmi2OK;
    for (size_t i = 0; i < count; i++) {
        if (references[i] >= FIRST_OUTPUT && self->of->stale) status = judged(self, component_update(self->of));
        if (!component_get(self->of, references[i], &values[i])) return refuse(self, "no variable has this reference");
        if (isnan(values[i])) status = fmi2Discard;
    }
    return status;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference references[], size_t count, const fmi2Real values[]) {
    instance *self = c;
    for (size_t i = 0; i < count; i++)
        if (!component_set(self->of, references[i], values[i]))
            return refuse(self, "a value that is not finite, or a variable that cannot be set");
    return fmi2OK;
}

/* There are variables of one type only. */
#define NONE(Type)                                                                                                     \
    fmi2Status fmi2Get##Type(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2##Type v[]) {                \
        (void)r, (void)v;                                                                                              \
        return n ? refuse(c, "there are variables of the type Real only") : fmi2OK;                                    \
    }                                                                                                                  \
    fmi2Status fmi2Set##Type(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2##Type v[]) {          \
        (void)r, (void)v;                                                                                              \
        return n ? refuse(c, "there are variables of the type Real only") : fmi2OK;                                    \
    }
NONE(Integer)
NONE(Boolean)
NONE(String)

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state) {
    instance *self = c;
    if (!state) return refuse(self, "no state is given");
    if (!*state) *state = calloc(1, sizeof self->of->now);
    if (!*state) return refuse(self, "no memory");
    memcpy(*state, &self->of->now, sizeof self->of->now);
    return fmi2OK;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
    instance *self = c;
    if (!state) return refuse(self, "no state is given");
    component_restore(self->of, state);
    return fmi2OK;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state) {
    (void)c;
    if (!state) return fmi2OK; /* as free has it, says the standard */
    free(*state);
    *state = NULL;
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size) {
    if (!state || !size) return refuse(c, "no state is given");
    *size = sizeof((instance *)c)->of->now;
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
    instance *self = c;
    if (!state || !bytes) return refuse(self, "no state is given");
    if (size < sizeof self->of->now) return refuse(self, "too little room for a state");
    memcpy(bytes, state, sizeof self->of->now);
    return fmi2OK;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state) {
    instance *self = c;
    if (!state || !bytes) return refuse(self, "no state is given");
    if (size != sizeof self->of->now) return refuse(self, "no state of this FMU");
    if (!*state) *state = calloc(1, size);
    if (!*state) return refuse(self, "no memory");
    memcpy(*state, bytes, size);
    return fmi2OK;
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[], size_t unknown_count,
                                        const fmi2ValueReference knowns[], size_t known_count, const fmi2Real seeds[],
                                        fmi2Real found[]) {
    instance *self = c;
    fmi2Status status = fmi2OK;
    for (size_t j = 0; j < known_count; j++)
        if (!IS_KNOWN(knowns[j])) return refuse(self, "derivative by neither input, parameter nor state");
    for (size_t i = 0; i < unknown_count; i++) {
        if (!component_is_unknown(unknowns[i])) return refuse(self, "derivative of neither output nor rate");
        found[i] = 0.0;
        for (size_t j = 0; j < known_count; j++) {
            double derivative;
            if (seeds[j] == 0.0) continue;
            const int code = component_derivative(self->of, unknowns[i], knowns[j], &derivative);
            if (EHD_REFUSES(code)) return judged(self, code);
            if (code) status = fmi2Warning;
            found[i] += derivative * seeds[j];
        }
    }
    return status;
}

/* Model Exchange. */

fmi2Status fmi2EnterEventMode(fmi2Component c) { return (void)c, fmi2OK; }

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info) {
    (void)c;
    memset(info, 0, sizeof *info);
    return fmi2OK;
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) { return (void)c, fmi2OK; }

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean keeps, fmi2Boolean *event, fmi2Boolean *end) {
    (void)c, (void)keeps;
    *event = *end = fmi2False;
    return fmi2OK;
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time) {
    ((instance *)c)->of->now.values[TIME] = time;
    return fmi2OK;
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real x[], size_t n) {
    (void)x;
    return n ? refuse(c, "there are no event indicators") : fmi2OK;
}

/* States of films, and their rates: none without memory. Solvers try states far from where they end: loads above the
 * map refuse forces, but no rates. */

static const char WRONG_COUNT[] = "another number of continuous states than there are";

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t n) {
    instance *self = c;
    if (n != FILMS) return refuse(self, WRONG_COUNT);
    for (size_t i = 0; i < n; i++)
        if (!component_set(self->of, FIRST_STATE + (unsigned)i, x[i])) return refuse(self, "a state that is not finite");
    return fmi2OK;
}

static fmi2Status get_all(instance *self, unsigned first, fmi2Real x[], size_t n) {
    if (n != FILMS) return refuse(self, WRONG_COUNT);
    const fmi2Status status = n ? judged(self, component_update(self->of) & ~EHD_ABOVE_LOAD) : fmi2OK;
    for (size_t i = 0; i < n; i++) component_get(self->of, first + (unsigned)i, &x[i]);
    return status;
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real x[], size_t n) { return get_all(c, FIRST_RATE, x, n); }

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t n) { return get_all(c, FIRST_STATE, x, n); }

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real x[], size_t n) {
    if (n != FILMS) return refuse(c, WRONG_COUNT);
    for (size_t i = 0; i < n; i++) x[i] = NOMINAL_STATE;
    return fmi2OK;
}

/* Co-Simulation: the inputs that are set before a step are those of its end, and so is the force, which the master
 * holds until the next one. */

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Integer o[],
                                       const fmi2Real v[]) {
    (void)r, (void)o, (void)v;
    return n ? refuse(c, "no derivatives of inputs are taken: poses have their velocities as inputs") : fmi2OK;
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Integer o[],
                                        fmi2Real v[]) {
    (void)r, (void)o, (void)v;
    return n ? refuse(c, "outputs have no derivatives by time") : fmi2OK;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real now, fmi2Real step, fmi2Boolean keeps) {
    instance *self = c;
    (void)keeps;
    if (!(isfinite(now) && isfinite(step) && step >= 0.0)) return refuse(self, "a step that is not finite and >= 0 s");
    const fmi2Status status = judged(self, component_step(self->of, step));
    if (status != fmi2Discard) self->of->now.values[TIME] = now + step;
    return status;
}

fmi2Status fmi2CancelStep(fmi2Component c) { return refuse(c, "steps are done at once and cannot be cancelled"); }

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value) {
    (void)c, (void)kind, (void)value;
    return fmi2Discard;
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value) {
    if (kind != fmi2LastSuccessfulTime) return fmi2Discard;
    *value = ((instance *)c)->of->now.values[TIME];
    return fmi2OK;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value) {
    (void)c, (void)kind, (void)value;
    return fmi2Discard;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value) {
    (void)c;
    if (kind != fmi2Terminated) return fmi2Discard;
    *value = fmi2False;
    return fmi2OK;
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *value) {
    (void)c, (void)kind, (void)value;
    return fmi2Discard;
}
