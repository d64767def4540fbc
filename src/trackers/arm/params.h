// What a person, a rig or a gesture gives the arm tracker: metres, seconds; pixels where a name says so. Constants of a single
// step stand beside it.
#pragma once

namespace duo::arm {

struct Params {
  // The body. Stereo sees skin; a joint lies behind it along the viewing ray.
  double hand_depth_m = 0.012;      // half the thickness of a hand
  double elbow_depth_m = 0.045;     // radius of an elbow
  double shoulder_depth_m = 0.062;  // radius of a shoulder with its cloth
  double upper_radius_m = 0.045;    // of the upper arm
  double fore_radius_m = 0.032;     // of the forearm
  double hand_length_m = 0.19;      // fingertips to wrist
  double hand_centre_m = 0.115;     // fingertips to the centre of a stretched hand
  double palm_m = 0.05;             // from the wrist to the hand's centre at least
  double least_hand_m2 = 0.0025;    // a hand seen edge on
  double shoulder_lift_m = 0.070;   // how far the collar bone lifts the joint when the upper arm turns from down to up, halved
  double shoulder_forward_m = 0.035;  // likewise along the viewing axis

  // Stereo.
  double disparity_sigma_px = 0.4;  // at full size
  double region_step_m = 0.025;     // neighbours within it belong together; hand before chest differs by more

  // Colour.
  double least_skin = 0.4;  // log likelihood ratio, skin against the person's cloth

  // Prediction, gates. Chosen on two clips, their mirror images and darkened copies.
  double hand_gate_m = 0.20;          // from the predicted hand
  double hand_gate_growth_m_s = 0.9;  // while it is hidden
  double hand_prior_m = 0.06;         // one sigma of the predicted hand
  double hand_prior_growth_m_s = 0.9;
  double elbow_prior_m = 0.07;
  double elbow_prior_growth_m_s = 0.6;
  double elbow_prior_hidden_hand_m = 0.04;  // added while the hand is hidden: nothing held the elbow
  double fastest_hand_m_s = 6;              // a thrown ball leaves at 25, a gesture stays far below 6
  double fastest_elbow_m_s = 4;

  // Honesty. One sigma of a joint that was measured; hidden ones grow.
  double hand_sigma_m = 0.021, elbow_sigma_m = 0.022, shoulder_sigma_m = 0.018;
  double hand_sigma_growth_m_s = 0.9, elbow_sigma_growth_m_s = 0.45, shoulder_sigma_growth_m_s = 0.6;
  double hand_depth_sigmas = 0.7;                            // a hand is many cells, but their errors agree
  double hand_cut_sigma_m = 0.07, elbow_cut_sigma_m = 0.05;  // added where the picture's border cuts the hand off
  double hand_lag = 0.15;                                    // sigma added per metre that the hand moved since the last frame
};

}  // namespace duo::arm
