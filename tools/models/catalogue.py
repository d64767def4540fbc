"""The models, where they come from, and what each of their outputs is called."""

PACKAGES = {
    "@mediapipe/pose@0.5.1675469404": "0c566c3564ec4a9851219a699d40aeba7cc18873f615d25747d7a173b98c8b8286fa83da387d049b777a92becfcbe4d2"
                                      "c935c2d5da07f3c29c176f24dac071b1",
    "@mediapipe/hands@0.4.1675469240": "1b1a19bcbd669a12711718eeca3eef9c2fbe248b889c6ce71c18a7e5ced94aafd16dc9c6c9f11c26b90cfdb32ee4ad4c"
                                       "cffd8aa3ebc45faffec1ec261073eb1e",
}
POSE, HANDS = PACKAGES

BODY = {"points": "Identity", "presence": "Identity_1", "heat": "Identity_3", "world": "Identity_4"}
HAND = {"points": "Identity", "presence": "Identity_1", "side": "Identity_2", "world": "Identity_3"}


def by_name(names):
    return lambda model: {ours: next(t for t in model.outputs if model.names[t] == theirs) for ours, theirs in names.items()}


def by_shape(model):
    """The detector's scores and boxes before they are joined: 28 x 28, 14 x 14, 7 x 7 places of 2, 2, 6 anchors."""
    out = {}
    for side, anchors in ((28, 2), (14, 2), (7, 6)):
        for name, values in (("scores", anchors), ("boxes", 12 * anchors)):
            out[f"{name}_{side}"] = max(t for t, shape in enumerate(model.shapes) if list(shape) == [1, side, side, values])
    return out


class Entry:
    def __init__(self, package, file, outputs, low, high, exponent):
        self.package, self.file, self.outputs = package, file, outputs
        # A byte of the picture, 0 .. 255, becomes low .. high; the model's input is that / 255.
        self.low, self.high, self.exponent = low, high, exponent


MODELS = {
    "person_detector": Entry(POSE, "pose_solution_packed_assets.data", by_shape, -255, 255, 6),
    "body_lite": Entry(POSE, "pose_landmark_lite.tflite", by_name(BODY), 0, 255, 7),
    "body_full": Entry(POSE, "pose_landmark_full.tflite", by_name(BODY), 0, 255, 7),
    "body_heavy": Entry(POSE, "pose_landmark_heavy.tflite", by_name(BODY), 0, 255, 7),
    "hand_lite": Entry(HANDS, "hand_landmark_lite.tflite", by_name(HAND), 0, 255, 7),
    "hand_full": Entry(HANDS, "hand_landmark_full.tflite", by_name(HAND), 0, 255, 7),
}
ON_DEMAND = ("body_heavy",)

# sha256 of what make writes, on every machine.
RESULTS = {
    "person_detector": "15067fca84ba80374df9cdba69580f4534e554ce2da405efb29192da36085d42",
    "body_lite": "784844aab54983d5a6699496b5c89f503658056ef4b8c23ebdc80190da6f07d3",
    "body_full": "85d04a30471c79493af04227c4b11cde26335649fcb9b25eb6e17223786c1e02",
    "body_heavy": "2ebf7139317bb4aeb845de9af5d2bcbe10270d957eb771bb3767614dee6571a8",
    "hand_lite": "f7f8044e2f36535fd6ac1d8156c010f0dbe5db1602d3844dd092c5c5ad8053dd",
    "hand_full": "1d1b0292e44703641bf18e0fddda5e30433cdab81134e8ad033952d053c49ae6",
}
